#include "ros/playback/tracker_offline.h"

#include <camera_calibration_parsers/parse.h>
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/TaskError.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/error_text.h"
#include "support/lens_info.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"
#include "support/tracker_table.h"

namespace laparoscope_servo {
namespace {

constexpr int kImages = 6;
const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};

std::vector<std::string> lines(const std::string& path) {
  std::vector<std::string> result;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) result.push_back(line);
  return result;
}

class TrackerOfflineTest : public testing::Test {
 protected:
  TrackerOfflineTest() {
    const cv::Mat texture = test_support::texture(cv::Size(320, 240));
    for (const Eigen::Matrix3d& g : test_support::motion(kImages, kRoi, 5.0))
      images_.push_back(test_support::view(texture, g));
    options_.parameters.roi = kRoi;
    options_.csv = out_.file("out.csv");
  }

  OfflineSummary run() {
    return trackOffline(
        options_, [](const OfflineSummary&, std::size_t) {},
        [this](std::size_t frame, const std::string& error) {
          reports_ += std::to_string(frame) + ": " + error + "\n";
        });
  }

  void writeFolder() {
    for (std::size_t k = 0; k < images_.size(); ++k) cv::imwrite(in_.file(std::to_string(k) + ".png"), images_[k]);
    options_.inputs = {in_.path()};
  }

  void writeBag() {
    options_.inputs = {in_.file("in.bag")};
    rosbag::Bag bag(options_.inputs.front(), rosbag::bagmode::Write);
    for (std::size_t k = 0; k < images_.size(); ++k) {
      const auto header = headerOf(k);
      bag.write("/scope/image_raw", timeOf(k), *cv_bridge::CvImage(header, "bgr8", images_[k]).toImageMsg());
      sensor_msgs::CameraInfo info;
      info.header = header;
      info.K = {300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0};
      bag.write("/scope/camera_info", timeOf(k), info);
    }
  }

  static ros::Time timeOf(std::size_t k) { return ros::Time(1000, 500) + ros::Duration(0.04 * static_cast<double>(k)); }
  static std_msgs::Header headerOf(std::size_t k) {
    std_msgs::Header header;
    header.frame_id = "optical";
    header.stamp = ros::Time(static_cast<double>(k) / 25.0);  // as those of a folder
    return header;
  }

  // Raw images of a lens, and a calibration file of it.
  void writeRawFolder(const image::Lens& lens, const std::string& calibration) {
    const test::LensView view(lens, cv::Size(320, 240));
    const cv::Mat texture = test_support::texture(cv::Size(420, 320));
    images_.clear();
    for (const Eigen::Matrix3d& g : test_support::motion(kImages, kRoi, 5.0)) images_.push_back(view(texture, g));
    writeFolder();
    options_.parameters.rectify = true;
    ASSERT_TRUE(camera_calibration_parsers::writeCalibration(calibration, "scope",
                                                             test_support::lensInfo(lens, cv::Size(320, 240))));
  }

  test_support::TemporaryFolder in_;
  test_support::TemporaryFolder out_;
  std::vector<cv::Mat> images_;
  OfflineOptions options_;
  std::string reports_;
};

// Beside the results that a case was recorded with: those of a first run, with two of them changed.
TEST_F(TrackerOfflineTest, TellsHowFarItIsFromWhatWasRecorded) {
  writeBag();
  options_.bag = out_.file("results.bag");
  EXPECT_TRUE(run().apart.empty()) << "nothing was recorded";
  {
    rosbag::Bag results(options_.bag, rosbag::bagmode::Read);
    rosbag::Bag bag(options_.inputs.front(), rosbag::bagmode::Append);
    int k = 0;
    for (const rosbag::MessageInstance& instance : rosbag::View(results, rosbag::TopicQuery("/tracker/homography"))) {
      Homography result = *instance.instantiate<Homography>();
      if (k == 2) result.corners[4] += 3.0;
      if (k == 3) result.state = Homography::SEARCHING;
      ++k;
      bag.write("/tracker/homography", instance.getTime(), result);
    }
    ASSERT_EQ(k, kImages);
  }
  options_.bag.clear();
  const OfflineSummary summary = run();
  EXPECT_EQ(summary.images, static_cast<std::size_t>(kImages));
  ASSERT_EQ(summary.apart.size(), static_cast<std::size_t>(kImages) - 1u);
  for (std::size_t k = 0; k < summary.apart.size(); ++k) EXPECT_NEAR(summary.apart[k], k == 2 ? 3.0 : 0.0, 1e-9) << k;
  EXPECT_EQ(summary.other_state, 1u);
}

TEST_F(TrackerOfflineTest, WritesALineForEveryImage) {
  writeFolder();
  const OfflineSummary summary = run();
  EXPECT_EQ(summary.images, static_cast<std::size_t>(kImages));
  EXPECT_EQ(summary.refused, 0u);
  EXPECT_EQ(summary.by_state[static_cast<std::size_t>(tracking::State::kTracking)], static_cast<std::size_t>(kImages));
  EXPECT_EQ(summary.times.size(), static_cast<std::size_t>(kImages));
  const auto table = lines(options_.csv);
  ASSERT_EQ(table.size(), static_cast<std::size_t>(kImages) + 1);
  EXPECT_EQ(table[0].substr(0, 17), "frame,stamp,state");
  EXPECT_EQ(table[1].substr(0, 22), "0,0,1,1,0,0,0,1,0,0,0,");
  EXPECT_EQ(table[3].substr(0, 9), "2,0.08000");
  ASSERT_EQ(summary.notes.size(), 1u);
  EXPECT_NE(summary.notes[0].find("no H"), std::string::npos) << "a folder has no camera_info";
}

TEST_F(TrackerOfflineTest, GivesTheSameNumbersTwiceAndForBagAndFolder) {
  writeFolder();
  run();
  const auto first = lines(options_.csv);
  run();
  const auto second = lines(options_.csv);
  writeBag();
  run();
  const auto bag = lines(options_.csv);
  ASSERT_EQ(first.size(), second.size());
  ASSERT_EQ(first.size(), bag.size());
  for (std::size_t k = 1; k < first.size(); ++k) {
    EXPECT_EQ(test_support::withoutTime(first[k]), test_support::withoutTime(second[k]));
    EXPECT_EQ(test_support::withoutTime(first[k]), test_support::withoutTime(bag[k]));
  }
}

TEST_F(TrackerOfflineTest, ResumesWithASearchForTheRegionOfTheFirstImage) {
  const cv::Mat texture = test_support::texture(cv::Size(320, 240));
  images_.clear();
  for (const Eigen::Matrix3d& g : test_support::motion(12, kRoi, 5.0))
    images_.push_back(test_support::view(texture, g));
  writeFolder();
  run();
  const auto whole = lines(options_.csv);
  options_.source.resume = 0.16;  // image 4
  EXPECT_EQ(run().images, 9u);
  const auto table = lines(options_.csv);
  ASSERT_EQ(table.size(), 10u);
  EXPECT_EQ(table[1].substr(0, 22), "0,0,1,1,0,0,0,1,0,0,0,");
  EXPECT_EQ(table[2].substr(0, 2), "4,");
  const auto stateOf = [](const std::string& row) { return row.substr(row.find(',', row.find(',') + 1) + 1, 2); };
  EXPECT_EQ(stateOf(table[2]), "2,") << "SEARCHING, until it is confirmed";
  ASSERT_EQ(stateOf(table.back()), "1,") << table.back();
  const auto found = geometry::apply(test_support::homographyIn(table.back()), kRoi.corners());
  EXPECT_LT(geometry::largestDistance(found, geometry::apply(test_support::homographyIn(whole.back()), kRoi.corners())),
            0.1);
}

TEST_F(TrackerOfflineTest, WritesABagWithTheImagesHeadersAndTimes) {
  writeBag();
  options_.bag = out_.file("out.bag");
  run();
  rosbag::Bag bag(options_.bag);
  std::size_t homographies = 0;
  std::size_t errors = 0;
  std::size_t areas = 0;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    if (const auto homography = instance.instantiate<Homography>()) {
      EXPECT_EQ(instance.getTopic(), "/tracker/homography");
      EXPECT_EQ(instance.getTime(), timeOf(homographies));
      EXPECT_EQ(homography->header.stamp, headerOf(homographies).stamp);
      EXPECT_EQ(homography->header.frame_id, "optical");
      EXPECT_TRUE(homography->has_intrinsics) << homographies;
      ++homographies;
    } else if (const auto error = instance.instantiate<TaskError>()) {
      EXPECT_TRUE(error->valid);
      ++errors;
    } else if (const auto area = instance.instantiate<AreaSelection>()) {
      EXPECT_EQ(area->occluded.size(), 196u);
      ++areas;
    }
  }
  EXPECT_EQ(homographies, static_cast<std::size_t>(kImages));
  EXPECT_EQ(errors, static_cast<std::size_t>(kImages));
  EXPECT_EQ(areas, static_cast<std::size_t>(kImages));
}

TEST_F(TrackerOfflineTest, WritesABagOfAVideoThatBeginsAtTimeZero) {
  writeFolder();
  options_.bag = out_.file("out.bag");
  run();
  rosbag::Bag bag(options_.bag);
  rosbag::View view(bag, rosbag::TopicQuery("/tracker/homography"));
  ASSERT_EQ(view.size(), static_cast<std::size_t>(kImages));
  EXPECT_EQ(view.begin()->instantiate<Homography>()->header.stamp, ros::Time(0, 0));
}

TEST_F(TrackerOfflineTest, WritesAVideoOfTheOverlay) {
  writeFolder();
  for (const char* name : {"out.avi", "out.mp4"}) {
    options_.overlay = out_.file(name);
    run();
    cv::VideoCapture video(options_.overlay);
    ASSERT_TRUE(video.isOpened()) << name;
    cv::Mat frame;
    int count = 0;
    while (video.read(frame)) ++count;
    EXPECT_EQ(count, kImages) << name;
    EXPECT_EQ(video.get(cv::CAP_PROP_FPS), 25.0) << name;
  }
}

TEST_F(TrackerOfflineTest, LeavesOutWhatCannotBeProcessedAndReportsIt) {
  writeFolder();
  std::ofstream(in_.file("3.png")) << "broken";
  const OfflineSummary summary = run();
  EXPECT_EQ(summary.images, static_cast<std::size_t>(kImages) - 1);
  EXPECT_EQ(summary.refused, 1u);
  EXPECT_NE(reports_.find("3.png"), std::string::npos) << reports_;
  const auto table = lines(options_.csv);
  EXPECT_EQ(table.size(), static_cast<std::size_t>(kImages));
  EXPECT_EQ(table[4].substr(0, 2), "4,") << "frames keep their numbers";
}

TEST_F(TrackerOfflineTest, EndsWhenTheFirstImageIsOfNoUse) {
  writeFolder();
  std::ofstream(in_.file("0.png")) << "broken";
  EXPECT_THROW(run(), std::runtime_error);
}

TEST_F(TrackerOfflineTest, EndsWhenTheRoiCannotBeSelected) {
  writeFolder();
  options_.parameters.roi = geometry::Rectangle{300.0, 70.0, 100.0, 90.0};
  try {
    run();
    FAIL() << "expected an error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("300"), std::string::npos) << error.what();
  }
  options_.parameters.roi.reset();
  EXPECT_THROW(run(), std::invalid_argument);
}

TEST_F(TrackerOfflineTest, EndsWhenThereIsNoImageBehindTheStart) {
  writeFolder();
  options_.source.start = 100.0;
  EXPECT_THROW(run(), SourceError);
}

TEST_F(TrackerOfflineTest, EndsBeforeTheWorkWhenAnOutputCannotBeWritten) {
  writeFolder();
  for (std::string OfflineOptions::*output : {&OfflineOptions::csv, &OfflineOptions::bag, &OfflineOptions::overlay}) {
    OfflineOptions options = options_;
    options.*output = out_.file("no/such/folder/out");
    try {
      trackOffline(
          options, [](const OfflineSummary&, std::size_t) { FAIL() << "an image was processed"; },
          [](std::size_t, const std::string&) {});
      FAIL() << "expected an error";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("no/such/folder"), std::string::npos) << error.what();
    }
  }
}

TEST_F(TrackerOfflineTest, DoesNotOverwriteItsInput) {
  writeBag();
  options_.bag = options_.inputs.front();
  EXPECT_THROW(run(), std::invalid_argument);
  options_.bag.clear();
  EXPECT_EQ(run().images, static_cast<std::size_t>(kImages));
}

TEST_F(TrackerOfflineTest, RectifiesByACalibrationFile) {
  for (const image::LensParameters& lens :
       {test::laparoscope(cv::Size(320, 240), 220.0), test::rational(cv::Size(320, 240), 220.0),
        test::equidistant(cv::Size(320, 240), 160.0)}) {
    options_.camera_info = out_.file("scope.yaml");
    writeRawFolder(image::Lens(lens), options_.camera_info);
    const OfflineSummary summary = run();
    EXPECT_EQ(summary.by_state[1], static_cast<std::size_t>(kImages));
    EXPECT_TRUE(summary.notes.empty());
    const std::vector<std::string> table = lines(options_.csv);
    ASSERT_EQ(table.size(), kImages + 1u);
    const auto motion = test_support::motion(kImages, kRoi, 5.0);
    for (int k = 0; k < kImages; ++k) {
      std::istringstream row(table[static_cast<std::size_t>(k) + 1]);
      std::vector<double> values;
      for (std::string cell; std::getline(row, cell, ',') && cell[0] != '"';) values.push_back(std::stod(cell));
      Eigen::Matrix3d g;
      for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = values[static_cast<std::size_t>(3 + i)];
      for (const Eigen::Vector2d& corner : kRoi.corners()) {
        EXPECT_LT((geometry::apply(g, corner) - geometry::apply(motion[static_cast<std::size_t>(k)], corner)).norm(),
                  0.2);
      }
    }
  }
}

TEST_F(TrackerOfflineTest, SaysThatDistortionIsNotCorrected) {
  options_.camera_info = out_.file("scope.yaml");
  writeRawFolder(image::Lens(test::laparoscope(cv::Size(320, 240), 220.0)), options_.camera_info);
  options_.parameters.rectify = false;
  const OfflineSummary summary = run();
  ASSERT_EQ(summary.notes.size(), 1u);
  EXPECT_NE(summary.notes[0].find("distortion"), std::string::npos);
}

TEST_F(TrackerOfflineTest, SaysWhatIsMissingToRectify) {
  writeRawFolder(image::Lens(test::laparoscope(cv::Size(320, 240), 220.0)), out_.file("scope.yaml"));
  const auto error = [this]() -> std::string { return test_support::errorText<std::exception>([&] { run(); }); };
  EXPECT_NE(error().find("camera_info"), std::string::npos) << error();
  options_.camera_info = out_.file("none.yaml");
  EXPECT_NE(error().find("none.yaml"), std::string::npos) << error();
  options_.camera_info = out_.file("other_size.yaml");
  ASSERT_TRUE(camera_calibration_parsers::writeCalibration(
      options_.camera_info, "scope",
      test_support::lensInfo(image::Lens(test::laparoscope(cv::Size(640, 480), 220.0)), cv::Size(640, 480))));
  EXPECT_NE(error().find("640x480"), std::string::npos) << error();
}

}  // namespace
}  // namespace laparoscope_servo
