#include "ros/tracker/tracker_parameters.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ros/common/parameters.h"

namespace laparoscope_servo {
namespace {

std::vector<std::string> errorsOf(const XmlRpc::XmlRpcValue& tree) {
  std::vector<std::string> errors;
  readTrackerParameters(tree, "/tracker", errors);
  return errors;
}

bool mentions(const std::vector<std::string>& errors, const std::string& text) {
  for (const std::string& error : errors) {
    if (error.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(TrackerParametersTest, AreTheDefaultsWhenNothingIsSet) {
  std::vector<std::string> errors;
  const TrackerParameters parameters = readTrackerParameters(XmlRpc::XmlRpcValue(), "/tracker", errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_FALSE(parameters.roi);
  EXPECT_EQ(parameters.tracking.esm.levels, tracking::TrackerConfig().esm.levels);
}

TEST(TrackerParametersTest, ReadEveryKindOfValue) {
  XmlRpc::XmlRpcValue tree;
  tree["rectified_images"] = true;
  tree["select_timeout"] = 2;
  tree["tracking"]["occlusion"]["colour"] = "published";
  tree["tracking"]["esm"]["levels"] = 2;
  tree["tracking"]["esm"]["robust"] = false;
  tree["tracking"]["quality"]["min_zncc"] = 0.5;
  std::vector<std::string> errors;
  const TrackerParameters parameters = readTrackerParameters(tree, "/tracker", errors);
  EXPECT_TRUE(errors.empty()) << errorReport(errors);
  EXPECT_EQ(parameters.imageKind(), ImageKind::kRectified);
  EXPECT_EQ(parameters.select_timeout, 2.0);
  EXPECT_EQ(parameters.tracking.occlusion.colour, tracking::ColourGate::kPublished);
  EXPECT_EQ(parameters.tracking.esm.levels, 2);
  EXPECT_FALSE(parameters.tracking.esm.robust);
  EXPECT_EQ(parameters.tracking.quality.min_zncc, 0.5);
}

TEST(TrackerParametersTest, RectifyRawImagesOnly) {
  XmlRpc::XmlRpcValue tree;
  tree["rectify"] = true;
  std::vector<std::string> errors;
  EXPECT_EQ(readTrackerParameters(tree, "/tracker", errors).imageKind(), ImageKind::kToRectify);
  EXPECT_TRUE(errors.empty()) << errorReport(errors);
  tree["rectified_images"] = true;
  EXPECT_TRUE(mentions(errorsOf(tree), "/tracker/rectify")) << errorReport(errorsOf(tree));
}

TEST(TrackerParametersTest, NameWhatIsWrongWithTheRobotsMotion) {
  XmlRpc::XmlRpcValue tree;
  tree["robot_motion"]["enabled"] = true;
  tree["robot_motion"]["fixed_frame"] = "/aesop_base";
  tree["robot_motion"]["depth"] = 0.0;
  tree["robot_motion"]["owner"] = "~aesop";
  tree["robot_motion"]["dept"] = 0.1;
  const std::vector<std::string> errors = errorsOf(tree);
  EXPECT_EQ(errors.size(), 4u) << errorReport(errors);
  for (const char* field : {"fixed_frame", "robot_motion/owner", "robot_motion/depth", "robot_motion/dept"})
    EXPECT_TRUE(mentions(errors, field)) << field;
}

TEST(TrackerParametersTest, NameWhatIsWrongWithTheExternalMask) {
  XmlRpc::XmlRpcValue tree;
  tree["external_mask"]["enabled"] = true;
  tree["external_mask"]["owner"] = "~instrument";
  tree["external_mask"]["max_age"] = -0.1;
  tree["external_mask"]["max_ag"] = 0.1;
  const std::vector<std::string> errors = errorsOf(tree);
  EXPECT_EQ(errors.size(), 3u) << errorReport(errors);
  for (const char* field : {"external_mask/owner", "external_mask/max_age", "external_mask/max_ag "})
    EXPECT_TRUE(mentions(errors, field)) << field << errorReport(errors);
}

TEST(TrackerParametersTest, NameWhatIsWrongWithTheViews) {
  XmlRpc::XmlRpcValue tree;
  tree["views"]["capacity"] = 0;
  tree["views"]["min_visible_fraction"] = 1.5;
  tree["views"]["arrival_centre"] = -1.0;
  tree["views"]["arrival_scale"] = 0.0;
  tree["views"]["arrival"] = 1.0;
  const std::vector<std::string> errors = errorsOf(tree);
  EXPECT_EQ(errors.size(), 5u) << errorReport(errors);
  for (const char* field : {"capacity", "min_visible_fraction", "arrival_centre", "arrival_scale", "views/arrival"})
    EXPECT_TRUE(mentions(errors, field)) << field;
}

TEST(TrackerParametersTest, KnowEveryName) {
  const std::pair<const char*, tracking::ColourGate> gates[] = {{"none", tracking::ColourGate::kNone},
                                                                {"published", tracking::ColourGate::kPublished},
                                                                {"normalised", tracking::ColourGate::kNormalised}};
  for (const auto& [name, gate] : gates) {
    XmlRpc::XmlRpcValue tree;
    tree["tracking"]["occlusion"]["colour"] = name;
    std::vector<std::string> errors;
    EXPECT_EQ(readTrackerParameters(tree, "/tracker", errors).tracking.occlusion.colour, gate) << name;
    EXPECT_TRUE(errors.empty()) << errorReport(errors);
  }
  const std::pair<const char*, tracking::Light> lights[] = {{"constant", tracking::Light::kConstant},
                                                            {"global", tracking::Light::kGlobal},
                                                            {"local", tracking::Light::kLocal}};
  for (const auto& [name, light] : lights) {
    XmlRpc::XmlRpcValue tree;
    tree["tracking"]["esm"]["light"] = name;
    std::vector<std::string> errors;
    EXPECT_EQ(readTrackerParameters(tree, "/tracker", errors).tracking.esm.light, light) << name;
    EXPECT_TRUE(errors.empty()) << errorReport(errors);
  }
}

TEST(TrackerParametersTest, ReportsAllErrorsAtOnce) {
  XmlRpc::XmlRpcValue tree;
  tree["select_timeout"] = -1.0;
  tree["roi"] = "1,2,3";
  tree["tracking"]["occlusion"]["colour"] = "pink";
  tree["tracking"]["esm"]["levels"] = 0;
  tree["tracking"]["esm"]["robust"] = "yes please";
  tree["tracking"]["quality"]["min_znc"] = 0.5;
  const std::vector<std::string> errors = errorsOf(tree);
  EXPECT_EQ(errors.size(), 6u) << errorReport(errors);
  for (const char* name :
       {"/tracker/select_timeout", "/tracker/roi", "/tracker/tracking/occlusion/colour", "/tracker/tracking/esm/levels",
        "/tracker/tracking/esm/robust", "/tracker/tracking/quality/min_znc"}) {
    EXPECT_TRUE(mentions(errors, name)) << name;
  }
}

TEST(TrackerParametersTest, TakeTheRoiAsATextOrAsAGroup) {
  XmlRpc::XmlRpcValue text;
  text["roi"] = "580,180,220,340";
  XmlRpc::XmlRpcValue group;
  group["roi"]["x"] = 580;
  group["roi"]["y"] = 180.0;
  group["roi"]["width"] = 220;
  group["roi"]["height"] = 340;
  for (const XmlRpc::XmlRpcValue& tree : {text, group}) {
    std::vector<std::string> errors;
    const TrackerParameters parameters = readTrackerParameters(tree, "/tracker", errors);
    EXPECT_TRUE(errors.empty()) << errorReport(errors);
    ASSERT_TRUE(parameters.roi);
    EXPECT_EQ(parameters.roi->x, 580.0);
    EXPECT_EQ(parameters.roi->y, 180.0);
    EXPECT_EQ(parameters.roi->width, 220.0);
    EXPECT_EQ(parameters.roi->height, 340.0);
  }
  XmlRpc::XmlRpcValue none;
  none["roi"] = "";
  std::vector<std::string> errors;
  EXPECT_FALSE(readTrackerParameters(none, "/tracker", errors).roi);
  EXPECT_TRUE(errors.empty());
}

TEST(TrackerParametersTest, RefuseARoiThatIsIncompleteOrOfAWrongType) {
  XmlRpc::XmlRpcValue incomplete;
  incomplete["roi"]["x"] = 1;
  incomplete["roi"]["width"] = 50;
  EXPECT_TRUE(mentions(errorsOf(incomplete), "roi/height")) << errorReport(errorsOf(incomplete));
  XmlRpc::XmlRpcValue misspelt;
  for (const char* part : {"x", "y", "width", "height", "w"}) misspelt["roi"][part] = 50;
  EXPECT_TRUE(mentions(errorsOf(misspelt), "roi/w")) << errorReport(errorsOf(misspelt));
  XmlRpc::XmlRpcValue number;
  number["roi"] = 580;
  EXPECT_TRUE(mentions(errorsOf(number), "roi"));
}

TEST(ParseRoi, ReadsFourNumbers) {
  const geometry::Rectangle roi = parseRoi("580, 180.5,220,340");
  EXPECT_EQ(roi.x, 580.0);
  EXPECT_EQ(roi.y, 180.5);
  EXPECT_EQ(roi.width, 220.0);
  EXPECT_EQ(roi.height, 340.0);
  EXPECT_EQ(roiText(roi), "580,180.5,220,340");
}

TEST(ParseRoi, RefusesAnythingElse) {
  for (const char* text : {"", ",", "1,2,3", "1,2,3,4,5", "1,2,3,4,", "1,,3,4", "a,2,3,4", "1,2,3,4px", "-1,2,3,4",
                           "1,2,0,4", "1,2,3,-4", "nan,2,3,4", "1,2,inf,4", "1e9,2,3,4", "1;2;3;4", "1 2 3 4"}) {
    EXPECT_THROW(parseRoi(text), std::invalid_argument) << text;
  }
}

TEST(ErrorReport, IsEmptyWithoutErrors) {
  EXPECT_EQ(errorReport({}), "");
  EXPECT_NE(errorReport({"a", "b"}).find("2 errors"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo
