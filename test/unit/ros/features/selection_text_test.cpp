#include "ros/features/selection_text.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using features::FeatureKind;
using features::FeatureSelection;

std::string errorOf(const std::string& text) {
  return test_support::errorText<std::invalid_argument>([&] { parseSelection(text); });
}

TEST(SelectionText, ReadsEveryShape) {
  const FeatureSelection selection = parseSelection(R"(
# what a surgeon's engineer writes
- {id: shaft, line: [[100, 50], [300, 80.5]], range: 12}
- {id: rim, ellipse: {centre: [160, 120], radii: [40, 30], angle: 0.2}, arc: [0.5, 2.0]}
- {id: trocar, ellipse: [[1, 2], [3, 4], [5, 6], [7, 8], [9, 10]]}
- {id: left dot, point: [80, 60], desired: [160, 120]}
- {id: outline, spline: [[20, 30], [60, 40], [70, 80], [50, 90]], closed: true}
- {id: view, motion: []}
- {id: liver, motion: [[60, 40], [260, 200]]}
- {id: clamp, pose: [0.01, -0.02, 0.12, 0, 0, 1.5707963267948966]}
)");
  ASSERT_EQ(selection.size(), 8u);
  EXPECT_EQ(selection[5].kind, FeatureKind::kMotion);
  EXPECT_TRUE(selection[5].points.empty());
  EXPECT_EQ(selection[6].points.size(), 2u);
  EXPECT_EQ(selection[7].kind, FeatureKind::kPose);
  ASSERT_TRUE(selection[7].pose);
  EXPECT_EQ(selection[7].pose->translation(), Eigen::Vector3d(0.01, -0.02, 0.12));
  EXPECT_LT((selection[7].pose->linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(selection[0].id, "shaft");
  EXPECT_EQ(selection[0].kind, FeatureKind::kLine);
  EXPECT_EQ(selection[0].points[1], Eigen::Vector2d(300.0, 80.5));
  EXPECT_EQ(selection[0].range, 12.0);
  EXPECT_EQ(selection[1].kind, FeatureKind::kEllipse);
  ASSERT_TRUE(selection[1].ellipse);
  EXPECT_EQ(selection[1].ellipse->centre, Eigen::Vector2d(160.0, 120.0));
  EXPECT_EQ(selection[1].ellipse->b, 30.0);
  EXPECT_EQ(selection[1].ellipse->angle, 0.2);
  ASSERT_TRUE(selection[1].arc);
  EXPECT_EQ(selection[1].arc->extent, 2.0);
  EXPECT_FALSE(selection[2].ellipse);
  EXPECT_EQ(selection[2].points.size(), 5u);
  EXPECT_EQ(selection[3].id, "left dot");
  EXPECT_EQ(selection[3].desired, Eigen::Vector2d(160.0, 120.0));
  EXPECT_EQ(selection[4].kind, FeatureKind::kSpline);
  EXPECT_EQ(selection[4].points.size(), 4u);
  EXPECT_TRUE(selection[4].closed);
}

TEST(SelectionText, ReadsCornersAndStoredPictures) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("liver.png");
  cv::imwrite(file, cv::Mat(30, 40, CV_8UC3, cv::Scalar(10, 20, 30)));
  const FeatureSelection selection = parseSelection(
      "- {id: tissue, corners: {region: [10, 20, 200, 150], count: 40}}\n"
      "- {id: all, corners: {}}\n"
      "- {id: liver, corners: {count: 7}, stored: " +
      file + "}\n- {id: one, point: [3, 4], stored: " + file + "}");
  ASSERT_EQ(selection.size(), 4u);
  EXPECT_EQ(selection[0].kind, FeatureKind::kPoint);
  ASSERT_TRUE(selection[0].corners);
  EXPECT_EQ(selection[0].corners->region, cv::Rect(10, 20, 200, 150));
  EXPECT_EQ(selection[0].corners->count, 40);
  EXPECT_TRUE(selection[0].picture.empty());
  ASSERT_TRUE(selection[1].corners);
  EXPECT_TRUE(selection[1].corners->region.empty());
  EXPECT_EQ(selection[2].picture.size(), cv::Size(40, 30));
  // One file is one picture.
  EXPECT_EQ(selection[3].picture.data, selection[2].picture.data);
  EXPECT_FALSE(selection[3].corners);
}

TEST(SelectionText, NamesWhatIsWrongWithCornersAndPictures) {
  EXPECT_EQ(errorOf("- {id: a, corners: {region: [1, 2, 3]}}"),
            "selection: a, line 1: region, expected [x, y, width, height] in whole px, width and height of 1 or more");
  EXPECT_NE(errorOf("- {id: a, corners: {region: [1, 2, 0, 5]}}").find("region"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, corners: {region: [1, 2, 3000000, 5]}}").find("region"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, corners: {region: [-2147483648, 2, 30, 5]}}").find("region"), std::string::npos);
  EXPECT_EQ(errorOf("- {id: a, corners: {count: many}}"),
            "selection: a, line 1: count = many, expected a whole number");
  EXPECT_NE(errorOf("- {id: a, corners: {number: 5}}").find("= number, expected region or count"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, corners: 7}").find("corners = 7"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, corners: [1, 2]}").find("corners, expected {region"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, corners: {}, point: [1, 2]}").find("its 2 shapes"), std::string::npos);
  EXPECT_EQ(errorOf("- {id: a, point: [1, 2], stored: liver.png}"),
            "selection: a, line 1: stored = liver.png, expected the whole path of a picture");
  EXPECT_EQ(errorOf("- {id: a, point: [1, 2], stored: /nowhere/liver.png}"),
            "selection: a, line 1: stored = /nowhere/liver.png, expected a picture that can be read: PNG, JPEG, ...");
}

TEST(SelectionText, ReadsJson) {
  EXPECT_EQ(parseSelection(R"([{"id": "a", "point": [80, 60.5]}])")[0].points[0], Eigen::Vector2d(80.0, 60.5));
}

TEST(SelectionText, NamesFeatureLineValueAndExpectation) {
  EXPECT_EQ(errorOf("- {id: a, point: [1, 2]}\n- {id: b, point: [1, two]}"),
            "selection: b, line 2: point = two, expected a number");
  EXPECT_EQ(errorOf("- {id: a, point: [1]}"), "selection: a, line 1: point, expected [x, y], px");
  EXPECT_EQ(errorOf("- {id: a, line: 7}"),
            "selection: a, line 1: line = 7, expected points: [[x, y], [x, y], ...], px");
  EXPECT_EQ(errorOf("- {point: [1, 2]}"), "selection: a feature, line 1: id, expected a name");
  EXPECT_NE(errorOf("- {id: a, lien: [[1, 2], [3, 4]]}").find("key lien"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, point: [1, 2], line: [[1, 2], [3, 4]]}").find("its 2 shapes"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a}").find("its 0 shapes"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, ellipse: {centre: [1, 2]}}").find("radii: [a, b]"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, ellipse: {centre: [1, 2], radii: [3, 4], tilt: 1}}").find("= tilt"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, spline: [[1, 2], [3, 4]], closed: round}").find("closed = round"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, point: [1, 2], range: far}").find("range = far"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, point: [1, 2], desired: 5}").find("desired = 5"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, pose: [1, 2, 3]}").find("six numbers"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, pose: [1, 2, 3, 4, 5, up]}").find("pose = up"), std::string::npos);
  EXPECT_NE(errorOf("- {id: a, pose: [1, 2, .nan, 4, 5, 6]}").find("finite numbers"), std::string::npos);
  EXPECT_NE(errorOf("- seven").find("a feature = seven"), std::string::npos);
}

// More than OpenCV reads.
TEST(SelectionText, RefusesAStoredPictureThatClaimsTooManyPixels) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("huge.ppm");
  std::ofstream(file) << "P6\n100000 100000\n255\nxxx";
  EXPECT_EQ(errorOf("- {id: a, point: [1, 2], stored: " + file + "}"),
            "selection: a, line 1: stored = " + file + ", expected a picture that can be read: PNG, JPEG, ...");
}

TEST(SelectionText, RefusesAKeyThatStandsTwice) {
  EXPECT_EQ(errorOf("- {id: a, point: [1, 2], point: [3, 4]}"),
            "selection: a, line 1: key = point, expected each key once");
  for (const char* text : {"- {id: a, id: b, point: [1, 2]}", "- {id: a, corners: {count: 3, count: 4}}",
                           "- {id: a, ellipse: {centre: [9, 9], radii: [5, 5], radii: [6, 6]}}"})
    EXPECT_NE(errorOf(text).find("expected each key once"), std::string::npos) << text;
}

TEST(SelectionText, TellsAllErrorsAtOnce) {
  const std::string error = errorOf("- {id: a, point: [x, y]}\n- {id: b}");
  for (const char* part : {"= x", "= y", "b, line 2"}) EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST(SelectionText, RefusesWhatIsNoList) {
  for (const char* text : {"", "[]", "7", "{id: a, point: [1, 2]}"})
    EXPECT_NE(errorOf(text).find("no list of features"), std::string::npos) << text;
  EXPECT_NE(errorOf("- {id: a, point: [1, 2}"), "");
}

TEST(SelectionText, RefusesWhatIsNestedWithoutEnd) {
  for (const char* const open : {"[", "{a: ", "- "}) {
    std::string text;
    for (int k = 0; k < 100000; ++k) text += open;
    EXPECT_NE(errorOf(text).find("nested"), std::string::npos) << open;
  }
  EXPECT_EQ(errorOf("# ------------------------------------------ a heading\n- {id: a, point: [1, 2]}\n"), "");
}

TEST(SelectionText, NamesTheFile) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("features.yaml");
  for (const bool there : {false, true}) {
    if (there) std::ofstream(file) << "- {id: a}\n";
    try {
      readSelection(file);
      FAIL() << there;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }
  std::ofstream(file) << "- {id: a, point: [1, 2]}\n";
  EXPECT_EQ(readSelection(file).size(), 1u);
}

}  // namespace
}  // namespace laparoscope_servo
