#include "ros/features/feature_trackers.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace laparoscope_servo {
namespace {

using XmlRpc::XmlRpcValue;

TEST(FeatureTrackers, MakesEachOfThem) {
  for (const std::string& kind : featureTrackers()) {
    FeatureInput input;
    std::vector<std::string> errors;
    EXPECT_NE(makeFeatureTracker(kind, {}, "/" + kind, input, errors), nullptr) << kind;
    EXPECT_TRUE(errors.empty()) << kind;
  }
}

TEST(FeatureTrackers, RefusesAKindThatIsNone) {
  FeatureInput input;
  std::vector<std::string> errors;
  try {
    makeFeatureTracker("lines", {}, "", input, errors);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "tracker 'lines', expected one of dots, edges, points, instrument, motion");
  }
}

TEST(FeatureTrackers, TakesTheParametersThatAllShare) {
  XmlRpcValue tree;
  tree["selection"] = "/tmp/features.yaml";
  tree["rectified_images"] = true;
  tree["input"]["max_gap"] = 0.5;
  FeatureInput input;
  std::vector<std::string> errors;
  makeFeatureTracker("edges", tree, "/edges", input, errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(input.selection, "/tmp/features.yaml");
  EXPECT_TRUE(input.rectified_images);
  EXPECT_EQ(input.input.max_gap, 0.5);
}

TEST(FeatureTrackers, NamesEveryWrongParameter) {
  XmlRpcValue tree;
  tree["tracking"]["rnge"] = 20.0;
  tree["tracking"]["min_radius"] = 50.0;
  tree["tracking"]["max_radius"] = 10.0;
  tree["image"]["bit_depth"] = 3;
  tree["selection"] = "features.yaml";
  FeatureInput input;
  std::vector<std::string> errors;
  EXPECT_EQ(makeFeatureTracker("dots", tree, "/dots", input, errors), nullptr);
  std::string all;
  for (const std::string& error : errors) all += error + "\n";
  for (const char* part : {"/dots/tracking/rnge", "/dots/tracking/min_radius", "/dots/image/bit_depth = 3",
                           "/dots/selection", "a path that begins with a slash"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
}

}  // namespace
}  // namespace laparoscope_servo
