// Raw images of a distorting lens, and what camera_info says of it.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "ros/tracker/result_messages.h"
#include "ros/tracker/tracker_session.h"
#include "support/lens_info.h"
#include "support/stamped_header.h"
#include "support/synthetic_sequence.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo {
namespace {

using test_support::at;
using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{40.0, 30.0, 90.0, 80.0};

TrackerParameters toRectify() {
  TrackerParameters parameters;
  parameters.rectify = true;
  parameters.roi = kRoi;
  return parameters;
}

class TrackerSessionLens : public testing::Test {
 protected:
  cv::Mat image(const Eigen::Matrix3d& g) const { return view_(scene_, g); }

  const image::Lens lens_{test::laparoscope(kSize, 220.0)};
  const test::LensView view_{lens_, kSize};
  const sensor_msgs::CameraInfo info_ = test_support::lensInfo(lens_, kSize);
  const cv::Mat scene_ = test_support::texture(cv::Size(420, 320));
  const std::vector<Eigen::Matrix3d> motion_ = test_support::motion(20, kRoi, 20.0);
  const cv::Mat first_ = image(Eigen::Matrix3d::Identity());
};

TEST_F(TrackerSessionLens, FollowsKnownMotionInRectifiedPixels) {
  TrackerSession session(toRectify());
  session.setCameraInfo(info_);
  for (std::size_t k = 0; k < motion_.size(); ++k) {
    const Processed processed = session.process(image(motion_[k]), at(0.04 * static_cast<double>(k)));
    ASSERT_EQ(processed.result.state, State::kTracking) << k << ": " << processed.result.reason;
    EXPECT_LT(geometry::cornerDistance(processed.result.g, motion_[k], kRoi), 0.2) << k;
    ASSERT_TRUE(processed.camera);
    EXPECT_EQ(processed.camera->fx, info_.P[0]);
    EXPECT_TRUE(processed.lens);
    EXPECT_TRUE(taskErrorMessage(processed).valid);
    EXPECT_FALSE(session.ignoresDistortion());
  }
}

TEST_F(TrackerSessionLens, WaitsForCameraInfoAndSaysSo) {
  TrackerSession session(toRectify());
  const Processed early = session.process(first_, at(1.0));
  EXPECT_EQ(early.result.state, State::kIdle);
  EXPECT_NE(early.result.reason.find("no camera_info"), std::string::npos) << early.result.reason;
  EXPECT_NE(early.selection_error.find("no camera_info"), std::string::npos);
  EXPECT_FALSE(early.camera);
  TrackerParameters without_roi = toRectify();
  without_roi.roi.reset();
  TrackerSession idle(without_roi);
  EXPECT_NE(idle.process(first_, at(1.0)).result.reason.find("no camera_info"), std::string::npos);
  EXPECT_NE(idle.process(first_, at(1.1), kRoi).selection_error.find("no camera_info"), std::string::npos);
  session.setCameraInfo(info_);
  EXPECT_TRUE(session.process(first_, at(2.0)).result.selected_now);
}

TEST_F(TrackerSessionLens, RefusesCameraInfoThatIsNoLensAndSaysWhy) {
  sensor_msgs::CameraInfo unknown = info_, nan = info_, count = info_, size = info_;
  unknown.distortion_model = "fov";
  nan.D[0] = std::numeric_limits<double>::quiet_NaN();
  count.D.resize(7);
  size.width = 1920;
  const std::pair<sensor_msgs::CameraInfo, const char*> cases[] = {
      {unknown, "'fov'"}, {nan, "nan"}, {count, "7 coefficients"}, {size, "1920x240"}};
  for (const auto& [bad, why] : cases) {
    TrackerSession session(toRectify());
    session.setCameraInfo(bad);
    const Processed processed = session.process(first_, at(1.0));
    EXPECT_EQ(processed.result.state, State::kIdle);
    EXPECT_NE(processed.result.reason.find(why), std::string::npos) << processed.result.reason;
    EXPECT_NE(processed.camera_error.find(why), std::string::npos) << processed.camera_error;
  }
}

TEST_F(TrackerSessionLens, GoesOnThroughBadCameraInfoWithoutATaskError) {
  TrackerSession session(toRectify());
  session.setCameraInfo(info_);
  session.process(first_, at(1.0));
  sensor_msgs::CameraInfo bad = info_;
  bad.D[0] = std::numeric_limits<double>::quiet_NaN();
  session.setCameraInfo(bad);
  const Processed through = session.process(first_, at(1.04));
  EXPECT_EQ(through.result.state, State::kTracking) << through.result.reason;
  EXPECT_FALSE(through.camera);
  EXPECT_FALSE(taskErrorMessage(through).valid);
  EXPECT_NE(through.camera_error.find("nan"), std::string::npos) << through.camera_error;
  EXPECT_NE(session.process(first_, at(1.08), kRoi).selection_error.find("nan"), std::string::npos);
  session.setCameraInfo(info_);
  EXPECT_TRUE(session.process(first_, at(1.12)).camera);
}

TEST_F(TrackerSessionLens, AnotherLensEndsTrackingWithTheReason) {
  TrackerSession session(toRectify());
  session.setCameraInfo(info_);
  session.process(first_, at(1.0));
  sensor_msgs::CameraInfo other = info_;
  other.header.stamp = ros::Time(1.02);
  session.setCameraInfo(other);
  EXPECT_EQ(session.process(first_, at(1.04)).result.state, State::kTracking);
  other.D[0] += 0.02;
  session.setCameraInfo(other);
  const Processed changed = session.process(first_, at(1.08));
  EXPECT_EQ(changed.result.state, State::kIdle);
  EXPECT_NE(changed.result.reason.find("lens changed"), std::string::npos) << changed.result.reason;
  EXPECT_TRUE(session.process(first_, at(1.12), kRoi).result.selected_now);
}

TEST_F(TrackerSessionLens, ImagesOfAnotherSizeNeedCameraInfoOfTheirs) {
  TrackerSession session(toRectify());
  session.setCameraInfo(info_);
  session.process(first_, at(1.0));
  const cv::Mat half = first_(cv::Rect(0, 0, 160, 120)).clone();
  for (const double stamp : {1.04, 1.08}) EXPECT_THROW(session.process(half, at(stamp)), ImageError);
  EXPECT_NE(session.process(half, at(1.12)).result.reason.find("size"), std::string::npos);
  const Processed refused = session.process(half, at(1.16), geometry::Rectangle{20, 20, 50, 50});
  EXPECT_EQ(refused.result.state, State::kIdle);
  EXPECT_NE(refused.selection_error.find("160x120"), std::string::npos) << refused.selection_error;
}

TEST_F(TrackerSessionLens, LeavesTheImageAloneUnlessItIsAskedToRectify) {
  TrackerParameters parameters = toRectify();
  parameters.rectify = false;
  TrackerSession session(parameters);
  session.setCameraInfo(info_);
  const Processed processed = session.process(first_, at(1.0));
  EXPECT_FALSE(processed.lens);
  EXPECT_TRUE(session.ignoresDistortion());
}

}  // namespace
}  // namespace laparoscope_servo
