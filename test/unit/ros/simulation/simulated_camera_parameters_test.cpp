#include <gtest/gtest.h>

#include "ros/common/parameters.h"
#include "ros/simulation/simulated_camera.h"

namespace laparoscope_servo {
namespace {

TEST(SimulatedCameraParameters, AllErrorsAreListed) {
  XmlRpc::XmlRpcValue tree = parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/simulation.yaml");
  tree["control"] = "/tmp/control";
  tree["camera"]["rate"] = 0.0;
  tree["camera"]["widht"] = 640;
  tree["tissue"]["image"] = 3;
  tree["instrument"]["start"][2].clear();
  tree["instrument"]["start"][2] = "deep";
  tree["light"]["beam_exponent"] = "1";
  ParameterReader reader(tree, "/camera");
  SimulatedCameraConfig config;
  reader.readAll(config);
  const std::string report = reader.report();
  for (const char* part : {"camera/rate", "is /camera/camera/width meant?", "camera/tissue/image",
                           "camera/instrument/start[2]", "camera/light/beam_exponent"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part << " in\n" << report;
  }
  EXPECT_EQ(reader.errors().size(), 5U) << report;
}

TEST(SimulatedCameraParameters, TheControlSocketIsRequired) {
  ParameterReader reader(XmlRpc::XmlRpcValue(), "/camera");
  SimulatedCameraConfig config;
  reader.readAll(config);
  ASSERT_EQ(reader.errors().size(), 1u) << reader.report();
  EXPECT_EQ(reader.errors()[0].rfind("/camera/control is not set, expected ", 0), 0u) << reader.errors()[0];
}

}  // namespace
}  // namespace laparoscope_servo
