#include "ros/playback/feature_offline.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <stdexcept>

#include "ros/features/selection_text.h"
#include "support/feature_scene.h"
#include "support/synthetic_model.h"
#include "support/synthetic_motion.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

constexpr int kImages = 5;
constexpr int kCovered = 3;  // this image shows nothing

class FeatureOfflineTest : public testing::TestWithParam<const char*> {
 protected:
  FeatureOfflineTest() {
    for (int k = 0; k < kImages; ++k) {
      const auto seed = static_cast<unsigned>(k + 1);
      cv::imwrite(in_.file(std::to_string(k) + ".png"),
                  k == kCovered ? test_support::coveredScene(seed) : test_support::featureScene(0.5 * k, seed));
    }
    options_.common.inputs = {in_.path()};
    options_.tracker = GetParam();
    options_.selection = parseSelection(GetParam() == std::string("dots") ? test_support::kDotsSelection
                                                                          : test_support::kEdgesSelection);
  }

  OfflineSummary run() {
    return trackFeaturesOffline(
        options_, [](const OfflineSummary&, std::size_t) {}, [](std::size_t, const std::string&) {});
  }

  // Of the table, without the header; split at commas, none of which is in these texts.
  std::vector<std::vector<std::string>> table() const {
    std::vector<std::vector<std::string>> rows;
    std::ifstream file(options_.common.csv);
    for (std::string line; std::getline(file, line);) {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }

  const test_support::TemporaryFolder in_, out_;
  FeatureOfflineOptions options_;
};

TEST_P(FeatureOfflineTest, WritesATableABagAndAVideo) {
  options_.common.csv = out_.file("out.csv");
  options_.common.bag = out_.file("out.bag");
  options_.common.overlay = out_.file("out.avi");
  const OfflineSummary summary = run();
  EXPECT_EQ(summary.images, static_cast<std::size_t>(kImages));
  EXPECT_EQ(summary.refused, 0u);
  EXPECT_EQ(summary.by_state[1], 3u);
  EXPECT_EQ(summary.by_state[2], 2u);

  const auto rows = table();
  ASSERT_EQ(rows.size(), 1u + 2u * kImages);
  EXPECT_EQ(rows[0].size(), 13u);
  EXPECT_EQ(rows[1][0], "0");
  EXPECT_EQ(rows[1][2], "1");
  EXPECT_EQ(rows[1][4], "\"" + options_.selection[0].id + "\"");
  EXPECT_EQ(rows[1][5], features::kindName(options_.selection[0].kind));
  EXPECT_EQ(rows[1][12], "\"\"");
  // Of the dot that is selected at (90, 50), or of the line at x = 220, in the third image, 1 px further.
  const std::vector<std::string>& row = GetParam() == std::string("dots") ? rows[6] : rows[5];
  std::istringstream parameters(row[9]);
  double first = 0.0;
  parameters >> first;
  EXPECT_NEAR(std::abs(first), GetParam() == std::string("dots") ? 91.0 : 221.0, 0.15);
  EXPECT_EQ(rows[1 + 2 * kCovered][6], "2");
  EXPECT_EQ(rows[1 + 2 * kCovered][8], "inf");
  EXPECT_NE(rows[1 + 2 * kCovered][12], "\"\"");

  rosbag::Bag bag(options_.common.bag);
  std::size_t messages = 0;
  for (const rosbag::MessageInstance& instance :
       rosbag::View(bag, rosbag::TopicQuery(std::string("/") + GetParam() + "/features"))) {
    const TrackedFeaturesConstPtr message = instance.instantiate<TrackedFeatures>();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->features.size(), 2u);
    ++messages;
  }
  EXPECT_EQ(messages, static_cast<std::size_t>(kImages));
  cv::VideoCapture video(options_.common.overlay);
  cv::Mat picture;
  ASSERT_TRUE(video.read(picture));
  EXPECT_EQ(picture.size(), cv::Size(320, 240));
}

TEST_P(FeatureOfflineTest, EndsWhereTheFirstImageDoesNotShowTheFeatures) {
  options_.selection[0].points = {{5000.0, 5.0}, {5000.0, 90.0}};
  if (GetParam() == std::string("dots")) options_.selection[0].points.pop_back();
  options_.common.csv = out_.file("out.csv");
  EXPECT_THROW(run(), std::invalid_argument);
  EXPECT_FALSE(std::ifstream(options_.common.csv).good());
}

TEST_P(FeatureOfflineTest, TakesParametersFromAFile) {
  options_.params = out_.file("params.yaml");
  std::ofstream(options_.params) << "tracking: {min_contrast: 250}\n";
  EXPECT_THROW(run(), std::invalid_argument);  // nothing has so much contrast
  std::ofstream(options_.params) << "tracking: {min_contrst: 20}\n";
  try {
    run();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("min_contrst"), std::string::npos) << error.what();
  }
}

TEST_P(FeatureOfflineTest, DoesNotOverwriteItsInput) {
  options_.common.csv = in_.path();
  EXPECT_THROW(run(), std::invalid_argument);
}

// The motion of drawn tissue; nothing is selected.
TEST(FeatureOffline, TellsMotionWithoutASelection) {
  const test_support::TemporaryFolder in, out;
  const motion::MotionField field = test::usualMotion();
  for (int k = 0; k < 3; ++k) cv::imwrite(in.file(std::to_string(k) + ".png"), test::movingTissue(k, field));
  FeatureOfflineOptions options;
  options.common.inputs = {in.path()};
  options.common.csv = out.file("out.csv");
  options.tracker = "motion";
  const OfflineSummary summary = trackFeaturesOffline(
      options, [](const OfflineSummary&, std::size_t) {}, [](std::size_t, const std::string&) {});
  EXPECT_EQ(summary.by_state[0], 1u);
  EXPECT_EQ(summary.by_state[1], 2u);
  std::ifstream file(options.common.csv);
  std::string line;
  for (int k = 0; k < 4; ++k) std::getline(file, line);
  EXPECT_NE(line.find("\"motion\",motion,1,"), std::string::npos) << line;
}

// An object of known shape, from a pose that is some degrees off.
TEST(ModelOffline, TellsThePosesOfAnObject) {
  const test_support::TemporaryFolder in, out;
  const auto model = test::modelOf(test::kCube);
  const test::ModelScene scene;
  const test::ModelRenderer renderer(*model, scene);
  const auto truth = [&](int k) { return test::viewOf(*model, 0.45, 0.6 + 0.01 * k); };
  for (int k = 0; k < 4; ++k)
    cv::imwrite(in.file(std::to_string(k) + ".png"), renderer.draw(truth(k), static_cast<unsigned>(k + 1)));
  std::ofstream(out.file("cube.cao")) << test::kCube;
  std::ofstream(out.file("params.yaml")) << "tracking: {file: " << out.file("cube.cao") << "}\n";
  FeatureOfflineOptions options;
  options.common.inputs = {in.path()};
  options.common.csv = out.file("out.csv");
  options.tracker = "model";
  options.params = out.file("params.yaml");
  options.selection.resize(1);
  options.selection[0].id = "cube";
  options.selection[0].kind = features::FeatureKind::kPose;
  options.selection[0].pose = truth(0) * Eigen::Translation3d(model->centre) *
                              Eigen::AngleAxisd(0.08, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(-model->centre);
  const auto run = [&options] {
    return trackFeaturesOffline(
        options, [](const OfflineSummary&, std::size_t) {}, [](std::size_t, const std::string&) {});
  };
  EXPECT_THROW(run(), std::invalid_argument) << "without the camera's intrinsics";
  std::ofstream(out.file("camera.yaml")) << R"(image_width: 320
image_height: 240
camera_name: drawn
camera_matrix: {rows: 3, cols: 3, data: [300, 0, 160, 0, 300, 120, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [300, 0, 160, 0, 0, 300, 120, 0, 0, 0, 1, 0]}
)";
  options.common.camera_info = out.file("camera.yaml");
  EXPECT_EQ(run().by_state[1], 4u);
  std::ifstream table(options.common.csv);
  std::string row;
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(std::getline(table, row));
  std::vector<std::string> cells;
  std::istringstream text(row);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  ASSERT_GE(cells.size(), 12u);
  EXPECT_EQ(cells[4], "\"cube\"");
  EXPECT_EQ(cells[5], "pose");
  std::istringstream numbers(cells[9]);
  Eigen::Vector3d position;
  numbers >> position.x() >> position.y() >> position.z();
  EXPECT_LT((position - truth(3).translation()).norm(), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(All, FeatureOfflineTest, testing::Values("dots", "edges"));

}  // namespace
}  // namespace laparoscope_servo
