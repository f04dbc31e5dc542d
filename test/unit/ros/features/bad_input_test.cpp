// Every tracker of features, as nodelets and the offline tool drive it, with whatever may be wrong with a selection, an
// image, its time or the camera: refused by name, value and expectation, and what was tracked is tracked on.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/se3.h"
#include "ros/features/feature_session.h"
#include "ros/features/feature_trackers.h"
#include "ros/features/selection_text.h"
#include "support/contour_scene.h"
#include "support/feature_scene.h"
#include "support/synthetic_model.h"
#include "support/synthetic_motion.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using features::State;

const std::string kNumbers[] = {".nan", ".inf", "-.inf", "1e5", "1e13", "-1e200"};

std::string splineText(const std::string& id, const std::vector<Eigen::Vector2d>& points, const std::string& closed) {
  std::ostringstream text;
  text << "[{id: " << id << ", closed: " << closed << ", spline: [";
  for (std::size_t k = 0; k < points.size(); ++k)
    text << (k > 0 ? ", [" : "[") << points[k].x() << ", " << points[k].y() << ']';
  text << "]}]";
  return text.str();
}

// What cannot be selected, and parts of what has to be said of it.
struct Bad {
  std::string text;
  std::vector<std::string> parts;
};

struct Kind {
  std::string name;
  std::string selection;
  std::vector<Bad> bad;
};

std::ostream& operator<<(std::ostream& stream, const Kind& kind) {
  return stream << kind.name;
}

std::vector<Bad> badPoints() {
  std::vector<Bad> bad = {{"[{id: off, point: [5000, 50]}]", {"off: ", "(5000, 50)", "expected", "image|picture"}},
                          {"[{id: off, point: [-3, -70]}]", {"off: ", "(-3, -70)", "expected"}},
                          {"[{id: two, point: [[1, 2], [3, 4]]}]", {"two", "point", "expected"}},
                          {"[{id: a, point: [90, 50], range: 0}]", {"a: range = 0, expected 1 to 100 px"}},
                          {"[{id: a, point: [90, 50], desired: [.nan, 2]}]", {"a: desired value = nan, expected"}},
                          {"[{id: a, point: [90, 50], desired: [1]}]", {"a: number of desired values = 1, expected"}},
                          {"[{id: a, line: [[10, 10], [90, 90]]}]", {"a: kind = line, expected point"}}};
  for (const std::string& number : kNumbers)
    bad.push_back({"[{id: a, point: [" + number + ", 50]}]", {"a: point = [", "expected two"}});
  return bad;
}

std::vector<Bad> badCurves() {
  std::vector<Bad> bad = {
      {"[{id: off, line: [[5000, 50], [5100, 90]]}]",
       {"off: line between (5000, 50) and (5100, 90), expected a part of it in the image of 320 x 240 px"}},
      {"[{id: off, ellipse: {centre: [-90, 50], radii: [30, 20]}}]", {"off: ellipse between", "image of 320 x 240"}},
      {splineText("off", {{10, 500}, {60, 510}, {90, 500}}, "false"), {"off: spline between", "image of 320 x 240"}},
      {"[{id: none, line: [[60, 60], [60, 60]]}]", {"none: line from (60, 60) to (60, 60), expected", "30 px apart"}},
      {"[{id: one, line: [[60, 60]]}]", {"one: number of points = 1, expected 2"}},
      {splineText("dot", {{50, 50}, {50, 50}, {50, 50}, {50, 50}}, "true"), {"dot: ", "neighbouring points = 0, exp"}},
      {splineText("few", {{50, 50}, {90, 90}}, "false"), {"few: number of points = 2, expected 3"}},
      {splineText("short", {{50, 50}, {55, 52}, {60, 50}}, "false"), {"short: ", "length = ", "expected at least 40"}},
      {"[{id: flat, ellipse: {centre: [90, 90], radii: [0, 20]}}]", {"flat: radius = 0, expected a positive number"}},
      {"[{id: tiny, ellipse: {centre: [90, 90], radii: [1, 20]}}]", {"tiny: ellipse: radius = 1, expected 3 px"}},
      {"[{id: point, ellipse: [[9, 9], [9, 9], [9, 9], [9, 9], [9, 9]]}]", {"point: ellipse: ", "= 0, expected"}},
      {"[{id: wide, ellipse: {centre: [90, 120], radii: [26, 22]}, arc: [0, 9]}]", {"wide: ", "arc = 9, expected"}},
      {"[{id: some, line: [[10, 10], [90, 90]], corners: {count: 3}}]", {"some", "2 shapes, expected one"}}};
  for (const std::string& number : kNumbers) {
    bad.push_back({"[{id: a, line: [[" + number + ", 50], [90, 50]]}]", {"a: point = [", "expected two"}});
    bad.push_back({"[{id: a, ellipse: {centre: [90, " + number + "], radii: [26, 22]}}]", {"a: centre, y = ", "exp"}});
    bad.push_back({"[{id: a, ellipse: {centre: [90, 120], radii: [" + number + ", 22]}}]", {"radius = ", "expected"}});
    bad.push_back({"[{id: a, spline: [[10, 10], [50, 50], [" + number + ", 90]]}]", {"a: point = [", "expected two"}});
  }
  return bad;
}

std::vector<Bad> badContours() {
  std::vector<Eigen::Vector2d> away = test_support::ContourScene::selection()[0].points;
  for (Eigen::Vector2d& point : away) point.x() += 1000.0;
  std::vector<Bad> bad = {
      {splineText("off", away, "true"), {"off: spline between", "expected a part of it in the image of 320 x 240 px"}},
      {splineText("open", {{50, 50}, {90, 90}, {50, 90}}, "false"), {"open: closed = false, expected true"}},
      {splineText("dot", {{50, 50}, {50, 50}, {50, 50}, {50, 50}}, "true"), {"dot: ", "neighbouring points = 0, exp"}},
      {splineText("small", {{50, 50}, {54, 50}, {54, 54}, {50, 54}}, "true"), {"small: ", "length = ", "expected"}},
      {"[{id: a, line: [[10, 10], [90, 90]]}]", {"a: kind = line, expected spline"}}};
  for (const std::string& number : kNumbers)
    bad.push_back({"[{id: a, closed: true, spline: [[10, 10], [50, 50], [" + number + ", 90], [10, 90]]}]",
                   {"a: point = [", "expected two"}});
  return bad;
}

std::vector<Bad> badMotions() {
  std::vector<Bad> bad = {
      {"[{id: off, motion: [[5000, 50], [5100, 150]]}]", {"off: region", "(5000, 50), expected", "320 x 240"}},
      {"[{id: none, motion: [[50, 50], [50, 50]]}]", {"none: region of 1 x 1 px at (50, 50), expected"}},
      {"[{id: one, motion: [[50, 50]]}]", {"one: number of points = 1, expected 0, or 2"}},
      {"[{id: a, motion: []}, {id: b, motion: []}]", {"2 features, expected 1"}},
      {"[{id: a, motion: [], desired: [1]}]", {"a: number of desired values = 1, expected"}}};
  for (const std::string& number : kNumbers)
    bad.push_back({"[{id: a, motion: [[" + number + ", 50], [90, 90]]}]", {"a: point = [", "expected two"}});
  return bad;
}

const Eigen::Isometry3d& cubePose() {
  static const Eigen::Isometry3d pose = test::viewOf(*test::modelOf(test::kCube), 0.45);
  return pose;
}

std::string poseText(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d turn = geometry::so3Log(pose.linear());
  std::ostringstream text;
  text << "[{id: cube, pose: [";
  for (int k = 0; k < 3; ++k) text << pose.translation()[k] << ", ";
  text << turn[0] << ", " << turn[1] << ", " << turn[2] << "]}]";
  return text.str();
}

std::vector<Bad> badPoses() {
  std::vector<Bad> bad = {
      {"[{id: behind, pose: [0, 0, -0.4, 0, 0, 0]}]", {"behind: ", "z = -", "expected it in front"}},
      {"[{id: aside, pose: [30, 0, 0.4, 0, 0, 0]}]", {"aside: ", "outside the image", "expected"}},
      {"[{id: five, pose: [0, 0, 1, 0, 0]}]", {"five", "pose, expected six numbers"}},
      {"[{id: a, point: [50, 50]}]", {"a: kind = point, expected pose"}}};
  for (const std::string number : {".nan", ".inf", "1e13", "-1e200"}) {
    bad.push_back({"[{id: a, pose: [0, " + number + ", 0.4, 0, 0, 0]}]", {"a", "pos", "expected"}});
    bad.push_back({"[{id: a, pose: [0, 0, " + number + ", 0, 0, 0]}]", {"a", "pos", "expected"}});
  }
  for (const std::string number : {".nan", ".inf", "1e200"})
    bad.push_back({"[{id: a, pose: [0, 0, 0.4, 0, " + number + ", 0]}]", {"a", "expected"}});
  return bad;
}

std::vector<Kind> kinds() {
  return {{"dots", test_support::kDotsSelection, badPoints()},
          {"points", test_support::kPointsSelection, badPoints()},
          {"edges", test_support::kEdgesSelection, badCurves()},
          {"contour", splineText("thing", test_support::ContourScene::selection()[0].points, "true"), badContours()},
          {"model", poseText(cubePose()), badPoses()},
          {"motion", "[{id: view, motion: []}]", badMotions()}};
}

class BadInput : public testing::TestWithParam<Kind> {
 protected:
  BadInput() {
    std::ofstream(folder_.file("cube.cao")) << test::kCube;
    XmlRpc::XmlRpcValue tree;
    if (GetParam().name == "model") tree["tracking"]["file"] = folder_.file("cube.cao");
    FeatureInput input;
    std::vector<std::string> errors;
    auto tracker = makeFeatureTracker(GetParam().name, tree, "", input, errors);
    EXPECT_TRUE(errors.empty());
    session_ = std::make_unique<FeatureSession>(input, std::move(tracker));
  }

  // No two pictures repeat.
  static cv::Mat picture(unsigned number) {
    const std::string& name = GetParam().name;
    if (name == "contour") {
      static const test_support::ContourScene scene([] {
        test_support::ContourScene::Look look;
        look.texture = 12.0;
        return look;
      }());
      return scene.image(0.0, number);
    }
    if (name == "model") {
      static const auto cube = test::modelOf(test::kCube);
      static const test::ModelRenderer renderer(*cube, test::ModelScene());
      return renderer.draw(cubePose(), number);
    }
    if (name == "motion") {
      static const cv::Mat tissue = test::tissue({320, 240}, 3);
      return test::view(tissue, Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, number);
    }
    return test_support::featureScene(0.0, number);
  }

  // In the next image.
  ProcessedFeatures next(const std::string& selection = "") {
    time_ += 0.04;
    std::optional<features::FeatureSelection> request;
    if (!selection.empty()) request = parseSelection(selection);
    return session_->process(*test_support::imageAt(picture(++number_), time_), request);
  }

  void select() {
    session_->setCameraInfo(info_);
    const ProcessedFeatures selected = next(GetParam().selection);
    ASSERT_TRUE(selected.selected_now) << selected.selection_error;
    count_ = selected.result.features.size();
    next();
    expectTracked();
  }

  void expectTracked() {
    const ProcessedFeatures told = next();
    EXPECT_EQ(told.result.state, State::kTracking) << told.result.reason;
    EXPECT_EQ(told.result.features.size(), count_);
  }

  // Each part, or one of those between its bars, is said.
  static void expectSaid(const std::string& said, const std::vector<std::string>& parts, const std::string& of) {
    for (const std::string& part : parts) {
      std::istringstream choices(part);
      bool found = false;
      for (std::string choice; std::getline(choices, choice, '|');) found = found || said.find(choice) != said.npos;
      EXPECT_TRUE(found) << of << "\n  was refused by: " << said << "\n  which lacks:    " << part;
    }
  }

  const test_support::TemporaryFolder folder_;
  std::unique_ptr<FeatureSession> session_;
  sensor_msgs::CameraInfo info_ = test_support::featureCamera();
  double time_ = 1000.0;
  unsigned number_ = 0;
  std::size_t count_ = 0;
};

TEST_P(BadInput, SelectionsAreRefusedByNameValueAndExpectation) {
  select();
  for (const Bad& bad : GetParam().bad) {
    std::string said;
    try {
      const ProcessedFeatures processed = next(bad.text);
      EXPECT_FALSE(processed.selected_now) << bad.text;
      EXPECT_EQ(processed.result.state, State::kTracking) << bad.text << ": " << processed.result.reason;
      said = processed.selection_error;
    } catch (const std::invalid_argument& error) {
      said = error.what();  // as YAML: there was no image
    }
    expectSaid(said, bad.parts, bad.text);
  }
  expectTracked();
}

TEST_P(BadInput, ImagesOfAnotherSizeAreRefused) {
  select();
  const cv::Mat small(120, 160, CV_8UC1, cv::Scalar(90));
  try {
    session_->process(*test_support::imageAt(small, time_ + 0.04));
    FAIL() << "was taken";
  } catch (const ImageError& error) {
    expectSaid(error.what(), {"160x120 px, grey", "those before 320x240 px"}, "a small image");
  }
  expectTracked();
}

TEST_P(BadInput, AnImageFromThePastIsRefused) {
  select();
  try {
    session_->process(*test_support::imageAt(picture(++number_), time_ - 5.0));
    FAIL() << "was taken";
  } catch (const ImageError& error) {
    expectSaid(error.what(), {"is stamped 5 s before the one before it", "believed after"}, "an old image");
  }
  expectTracked();
}

TEST_P(BadInput, ACameraThatCannotBeIsNamedWhereItIsNeeded) {
  for (const double wrong : {0.0, -300.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    info_.K[0] = wrong;
    session_->setCameraInfo(info_);
    const ProcessedFeatures processed = next(GetParam().selection);
    expectSaid(processed.camera_error, {"camera_info cannot be used: K", "expected"}, std::to_string(wrong));
    EXPECT_EQ(processed.selected_now, GetParam().name != "model") << processed.selection_error;
    if (!processed.selected_now) expectSaid(processed.selection_error, {"camera_info"}, std::to_string(wrong));
  }
  info_.K[0] = 300.0;
  select();
}

INSTANTIATE_TEST_SUITE_P(All, BadInput, testing::ValuesIn(kinds()),
                         [](const testing::TestParamInfo<Kind>& each) { return each.param.name; });

// Found without a click: there is nothing to select.
TEST(BadInputOfInstruments, ASelectionIsRefused) {
  FeatureInput input;
  std::vector<std::string> errors;
  FeatureSession session(input, makeFeatureTracker("instrument", {}, "", input, errors));
  const ProcessedFeatures processed = session.process(*test_support::imageAt(test::tissue({320, 240}, 3), 1.0),
                                                      parseSelection(test_support::kEdgesSelection));
  EXPECT_FALSE(processed.selected_now);
  EXPECT_EQ(processed.selection_error,
            "selection: 2 features, expected none: instruments are found without a selection");
}

}  // namespace
}  // namespace laparoscope_servo
