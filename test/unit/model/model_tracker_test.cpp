// The tracker of models: accuracy, states, bad input.
#include "laparoscope_servo/model/model_tracker.h"

#include <gtest/gtest.h>

#include "support/error_text.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

using features::Reason;
using features::State;

// The largest distance between where the model's points are seen from two poses, px.
double cornerError(const CadModel& model, const geometry::PinholeCamera& camera, const Eigen::Isometry3d& a,
                   const Eigen::Isometry3d& b) {
  double largest = 0.0;
  for (const Eigen::Vector3d& point : model.points) {
    const Eigen::Vector3d p = camera.matrix() * (a * point), q = camera.matrix() * (b * point);
    largest = std::max(largest, (p.hnormalized() - q.hnormalized()).norm());
  }
  return largest;
}

class ModelTrackerTest : public ::testing::Test {
 protected:
  explicit ModelTrackerTest(const std::string& text = test::kCube)
      : model_(test::modelOf(text)), renderer_(*model_, scene_), tracker_(model_, scene_.camera) {}

  Eigen::Isometry3d truth(int k) const {
    Eigen::Isometry3d pose = test::viewOf(*model_, 0.45 + 0.03 * std::sin(k / 9.0), 0.6 + 0.2 * std::sin(k / 11.0));
    pose.translation().x() += 0.02 * std::sin(k / 7.0);
    pose.translation().y() += 0.015 * std::sin(k / 6.0);
    return pose;
  }
  cv::Mat image(int k) const { return renderer_.draw(truth(k), static_cast<unsigned>(k + 1)); }
  static double stamp(int k) { return 0.04 * k; }
  double error(int k) const { return cornerError(*model_, scene_.camera, tracker_.result().camera_T_object, truth(k)); }

  test::ModelScene scene_;
  std::shared_ptr<const CadModel> model_;
  test::ModelRenderer renderer_;
  ModelTracker tracker_;
};

TEST_F(ModelTrackerTest, followsACubeToAFractionOfAPixel) {
  EXPECT_EQ(tracker_.result().state, State::kIdle);
  EXPECT_TRUE(tracker_.select(image(0), 0.0, truth(0)).selected_now);
  for (int k = 1; k < 25; ++k) {
    const ModelResult& result = tracker_.track(image(k), stamp(k));
    ASSERT_EQ(result.state, State::kTracking) << features::reasonText(result.reason);
    EXPECT_FALSE(result.selected_now);
    EXPECT_LT(error(k), 0.4) << k;
    EXPECT_LT(error(k), 5.0 * result.expected_error);
    EXPECT_GT(result.share, 0.75);
  }
}

// The covariance is of the pose in the camera's frame: errors of many images lie within it.
TEST_F(ModelTrackerTest, theCovarianceHoldsWhatTheErrorsAre) {
  geometry::Vector6d squares = geometry::Vector6d::Zero(), told = geometry::Vector6d::Zero();
  constexpr int kImages = 30;
  for (int k = 0; k < kImages; ++k) {
    const cv::Mat one = renderer_.draw(truth(0), static_cast<unsigned>(100 + k));
    const ModelResult& result = tracker_.select(one, 0.0, truth(0));
    geometry::Vector6d error;
    error << result.camera_T_object.translation() - truth(0).translation(),
        geometry::so3Log(result.camera_T_object.linear() * truth(0).linear().transpose());
    squares += error.cwiseAbs2() / kImages;
    told += result.covariance.diagonal() / kImages;
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::sqrt(squares[i]), 2.0 * std::sqrt(told[i])) << i;
    EXPECT_GT(std::sqrt(squares[i]), 0.1 * std::sqrt(told[i])) << i;
  }
}

TEST_F(ModelTrackerTest, isLostBehindACoverAndComesBack) {
  tracker_.select(image(0), 0.0, truth(0));
  for (int k = 1; k < 5; ++k) tracker_.track(image(k), stamp(k));
  const cv::Mat grey(scene_.size, CV_8UC1, cv::Scalar(100));
  for (int k = 5; k < 8; ++k) {
    EXPECT_EQ(tracker_.track(grey, stamp(k)).state, State::kSearching);
    EXPECT_NE(tracker_.result().reason, Reason::kNone);
    EXPECT_TRUE(std::isinf(tracker_.result().expected_error));
  }
  EXPECT_EQ(tracker_.track(grey, 3.0).state, State::kLost);
  EXPECT_EQ(tracker_.track(image(5), 3.04).reason, Reason::kNotConfirmed);
  EXPECT_EQ(tracker_.track(image(5), 3.08).reason, Reason::kNotConfirmed);
  EXPECT_EQ(tracker_.track(image(5), 3.12).state, State::kTracking);
  EXPECT_LT(error(5), 0.4);
}

// Half of the picture is covered by something grey.
TEST_F(ModelTrackerTest, staysOnAHalfCoveredCube) {
  tracker_.select(image(0), 0.0, truth(0));
  for (int k = 1; k < 12; ++k) {
    cv::Mat covered = image(k);
    if (k > 3) covered(cv::Rect(0, 0, 165, 240)).setTo(cv::Scalar(70));
    ASSERT_EQ(tracker_.track(covered, stamp(k)).state, State::kTracking) << k;
    EXPECT_LT(error(k), 3.0) << k;
  }
}

TEST_F(ModelTrackerTest, takesTheCamerasMotionFromElsewhere) {
  tracker_.select(image(0), 0.0, truth(0));
  // Far more in one image than the range: 60 px.
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation().x() = 0.09;
  const Eigen::Isometry3d there = motion * truth(0);
  EXPECT_EQ(tracker_.track(renderer_.draw(there, 9), 0.04, motion).state, State::kTracking)
      << features::reasonText(tracker_.result().reason);
  EXPECT_LT(cornerError(*model_, scene_.camera, tracker_.result().camera_T_object, there), 0.4);
  // One that is no motion is ignored.
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity();
  wrong.translation().x() = std::nan("");
  EXPECT_EQ(tracker_.track(renderer_.draw(there, 10), 0.08, wrong).state, State::kTracking);
}

TEST_F(ModelTrackerTest, theSameImagesGiveTheSameNumbers) {
  ModelTracker other(model_, scene_.camera);
  tracker_.select(image(0), 0.0, truth(1));
  other.select(image(0), 0.0, truth(1));
  for (int k = 1; k < 6; ++k) {
    const Eigen::Matrix4d a = tracker_.track(image(k), stamp(k)).camera_T_object.matrix();
    EXPECT_EQ(a, other.track(image(k), stamp(k)).camera_T_object.matrix());
  }
}

TEST_F(ModelTrackerTest, colouredImagesAreTakenByTheirLuma) {
  cv::Mat coloured;
  cv::cvtColor(image(0), coloured, cv::COLOR_GRAY2BGR);
  tracker_.select(coloured, 0.0, truth(0));
  EXPECT_LT(error(0), 0.4);
}

TEST_F(ModelTrackerTest, timeThatJumpsBackAndAnotherImageReset) {
  tracker_.select(image(0), 1.0, truth(0));
  EXPECT_EQ(tracker_.track(image(0), 0.9).reason, Reason::kTimeJumpedBack);
  EXPECT_EQ(tracker_.result().state, State::kIdle);
  tracker_.select(image(0), 1.0, truth(0));
  EXPECT_EQ(tracker_.track(image(0)(cv::Rect(0, 0, 300, 240)).clone(), 1.1).reason, Reason::kImageChanged);
  tracker_.select(image(0), 1.0, truth(0));
  tracker_.reset();
  EXPECT_EQ(tracker_.result().reason, Reason::kReset);
  EXPECT_EQ(tracker_.track(image(0), 1.1).state, State::kIdle);
}

TEST_F(ModelTrackerTest, aSelectionThatCannotBeIsRefusedAndTrackingGoesOn) {
  tracker_.select(image(0), 0.0, truth(0));
  const auto refusal = [&](const cv::Mat& pixels, double time, const Eigen::Isometry3d& pose) {
    return test_support::errorText<std::invalid_argument>([&] { tracker_.select(pixels, time, pose); });
  };
  Eigen::Isometry3d behind = truth(0), skewed = truth(0);
  behind.translation().z() = -0.5;
  skewed.linear() *= 1.1;
  EXPECT_NE(refusal(image(0), 0.0, behind).find("in front of the camera"), std::string::npos);
  EXPECT_NE(refusal(image(0), 0.0, skewed).find("not rigid"), std::string::npos);
  EXPECT_NE(refusal(cv::Mat(), 0.0, truth(0)).find("0 x 0"), std::string::npos);
  EXPECT_NE(refusal(image(0), std::nan(""), truth(0)).find("stamp"), std::string::npos);
  const cv::Mat grey(scene_.size, CV_8UC1, cv::Scalar(100));
  EXPECT_NE(refusal(grey, 0.0, truth(0)).find("no start"), std::string::npos);
  EXPECT_EQ(tracker_.track(image(1), stamp(1)).state, State::kTracking);
}

TEST(ModelTrackerInput, refusesACameraAndAConfigurationThatCannotBe) {
  const auto model = test::modelOf(test::kCube);
  EXPECT_THROW(ModelTracker(model, geometry::PinholeCamera()), std::invalid_argument);
  EXPECT_THROW(ModelTracker(nullptr, {300.0, 300.0, 160.0, 120.0}), std::invalid_argument);
  ModelConfig config;
  config.start_share = 2.0;
  EXPECT_THROW(ModelTracker(model, {300.0, 300.0, 160.0, 120.0}, config), std::invalid_argument);
}

class TubeTest : public ModelTrackerTest {
 protected:
  TubeTest() : ModelTrackerTest(test::kCubeAndTube) {}
};

TEST_F(TubeTest, followsACubeAndATubeThatHidesPartOfIt) {
  tracker_.select(image(0), 0.0, truth(0));
  for (int k = 1; k < 15; ++k) {
    ASSERT_EQ(tracker_.track(image(k), stamp(k)).state, State::kTracking) << k;
    EXPECT_LT(error(k), 0.5) << k;
  }
}

class LoneTubeTest : public ModelTrackerTest {
 protected:
  LoneTubeTest() : ModelTrackerTest("V1\n2\n0 0 0\n0 0 2\n0\n0\n0\n1\n0 1 0.02\n0\n") {}
};

// Two parallel sides that leave the image: neither the turn about the axis nor sliding along it shows, and the
// covariance says so.
TEST_F(LoneTubeTest, whatATubeLeavesOpenIsInItsCovariance) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = geometry::so3Exp({1.5, 0.1, 0.0});
  pose.translation() = Eigen::Vector3d(0.0, 0.0, 0.4) - pose.linear() * model_->centre;
  ModelConfig config;
  config.start_rotation = 0.0;
  config.start_shift = 0.0;
  ModelTracker tracker(model_, scene_.camera, config);
  const ModelResult& result = tracker.select(renderer_.draw(pose, 1), 0.0, pose);
  ASSERT_EQ(result.state, State::kTracking);
  // Along the axis, and about it.
  const Eigen::Vector3d axis = pose.linear().col(2), across = axis.cross(Eigen::Vector3d::UnitZ()).normalized();
  const auto variance = [&](const geometry::Matrix6d& c, int block, const Eigen::Vector3d& d) {
    return d.dot(c.block<3, 3>(3 * block, 3 * block) * d);
  };
  // About the model's centre: the object's origin is far from what is seen.
  geometry::Matrix6d shift = geometry::Matrix6d::Identity();
  shift.topRightCorner<3, 3>() = -geometry::skew(pose.linear() * model_->centre);
  const geometry::Matrix6d at_centre = shift * result.covariance * shift.transpose();
  EXPECT_GT(variance(at_centre, 0, axis), 1e3 * variance(at_centre, 0, across));
  EXPECT_GT(variance(at_centre, 1, axis), 1e2 * variance(at_centre, 1, Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace laparoscope_servo::model
