#include "ros/simulation/scene_parameters.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

XmlRpc::XmlRpcValue shipped() {
  return parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/simulation.yaml");
}

// Number of parameters in the tree.
int leaves(XmlRpc::XmlRpcValue& tree) {
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return 1;
  int count = 0;
  for (auto& member : tree) count += leaves(member.second);
  return count;
}

TEST(SceneParameters, ShippedFileHasTheDefaults) {
  ParameterReader reader(shipped(), "camera");
  const sim::SceneConfig file = readSceneConfig(reader), defaults;
  ASSERT_TRUE(reader.errors().empty()) << reader.report();
  EXPECT_EQ(file.camera.width, defaults.camera.width);
  EXPECT_EQ(file.camera.height, defaults.camera.height);
  EXPECT_EQ(file.camera.intrinsics.matrix(), defaults.camera.intrinsics.matrix());
  EXPECT_EQ(file.camera.rate, defaults.camera.rate);
  EXPECT_EQ(file.camera.supersampling, defaults.camera.supersampling);
  EXPECT_EQ(file.camera.noise, defaults.camera.noise);
  EXPECT_EQ(file.camera.noise_seed, defaults.camera.noise_seed);
  EXPECT_EQ(file.camera.border_radius, defaults.camera.border_radius);
  EXPECT_EQ(file.tissue.image, defaults.tissue.image);
  EXPECT_EQ(file.tissue.seed, defaults.tissue.seed);
  EXPECT_EQ(file.tissue.texture_side, defaults.tissue.texture_side);
  EXPECT_EQ(file.tissue.width, defaults.tissue.width);
  EXPECT_EQ(file.tissue.distance, defaults.tissue.distance);
  EXPECT_EQ(file.tissue.tilt_x, defaults.tissue.tilt_x);
  EXPECT_EQ(file.tissue.tilt_y, defaults.tissue.tilt_y);
  EXPECT_EQ(file.light.reference_distance, defaults.light.reference_distance);
  EXPECT_EQ(file.light.beam_exponent, defaults.light.beam_exponent);
  EXPECT_EQ(file.exposure.automatic, defaults.exposure.automatic);
  EXPECT_EQ(file.exposure.gain, defaults.exposure.gain);
  EXPECT_EQ(file.exposure.target, defaults.exposure.target);
  EXPECT_EQ(file.exposure.time_constant, defaults.exposure.time_constant);
  EXPECT_EQ(file.instrument.radius, defaults.instrument.radius);
  EXPECT_EQ(file.instrument.trocar, defaults.instrument.trocar);
  EXPECT_EQ(file.instrument.start, defaults.instrument.start);
  EXPECT_EQ(file.instrument.end, defaults.instrument.end);
  EXPECT_EQ(file.instrument.crossing_time, defaults.instrument.crossing_time);
  EXPECT_EQ(file.instrument.period, defaults.instrument.period);
}

// With refuseUnknown this means: the file names every parameter there is, and no other.
TEST(SceneParameters, ShippedFileNamesAllOfThem) {
  XmlRpc::XmlRpcValue tree = shipped();
  EXPECT_EQ(leaves(tree), 30);
}

TEST(SceneParameters, AllErrorsAreListed) {
  XmlRpc::XmlRpcValue tree = shipped();
  tree["camera"]["rate"] = 0.0;
  tree["camera"]["widht"] = 640;
  tree["tissue"]["image"] = 3;
  tree["instrument"]["start"][2].clear();
  tree["instrument"]["start"][2] = "deep";
  tree["light"]["beam_exponent"] = "1";
  ParameterReader reader(tree, "camera");
  readSceneConfig(reader);
  const std::string report = reader.report();
  for (const char* part : {"camera/rate", "camera/camera/widht", "camera/tissue/image", "camera/instrument/start[2]",
                           "camera/light/beam_exponent"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part << " in\n" << report;
  }
  EXPECT_EQ(reader.errors().size(), 5U) << report;
}

}  // namespace
}  // namespace laparoscope_servo
