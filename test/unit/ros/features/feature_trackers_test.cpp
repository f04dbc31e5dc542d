#include "ros/features/feature_trackers.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using XmlRpc::XmlRpcValue;

// A triangle.
constexpr char kModel[] = "V1\n3\n0 0 0\n0.1 0 0\n0 0.1 0\n0\n0\n1\n3 0 1 2\n0\n0\n";

TEST(FeatureTrackers, MakesEachOfThem) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.file("object.cao")) << kModel;
  for (const std::string& kind : featureTrackers()) {
    XmlRpcValue tree;
    tree["select_timeout"] = 5.0;
    if (kind == "model") tree["tracking"]["file"] = folder.file("object.cao");
    FeatureInput input;
    std::vector<std::string> errors;
    EXPECT_NE(makeFeatureTracker(kind, tree, "/" + kind, input, errors), nullptr) << kind;
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
    EXPECT_STREQ(error.what(),
                 "tracker 'lines', expected one of dots, edges, points, contour, instrument, model, motion");
  }
}

TEST(FeatureTrackers, RefusesAModelThatCannotBeReadWithFileAndLine) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("object.cao");
  std::string text = kModel;
  std::ofstream(file) << text.replace(text.find("3 0 1 2"), 7, "3 0 1 7");
  const auto errorOf = [](const XmlRpcValue& tree) {
    FeatureInput input;
    std::vector<std::string> errors;
    EXPECT_EQ(makeFeatureTracker("model", tree, "/model", input, errors), nullptr);
    return errors.empty() ? std::string() : errors.front();
  };
  XmlRpcValue tree;
  tree["tracking"]["file"] = file;
  EXPECT_EQ(errorOf(tree).rfind("/model/tracking/file: " + file + ", line 9: ", 0), 0u) << errorOf(tree);
  tree["tracking"]["file"] = "/nowhere/object.cao";
  EXPECT_NE(errorOf(tree).find("/nowhere/object.cao"), std::string::npos) << errorOf(tree);
  tree["tracking"]["file"] = "object.cao";
  EXPECT_NE(errorOf(tree).find("a path that begins with a slash"), std::string::npos) << errorOf(tree);
  EXPECT_NE(errorOf({}).find("/model/tracking/file"), std::string::npos) << "it has to be given";
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
