#include "ros/tracker/result_messages.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo {
namespace {

Eigen::Matrix3d someHomography() {
  Eigen::Matrix3d g;
  g << 1.02, -0.03, 12.0,  //
      0.02, 0.98, -7.0,    //
      1e-5, -2e-5, 1.0;
  return geometry::normaliseDeterminant(g);
}

Processed tracked() {
  Processed processed;
  processed.header.frame_id = "laparoscope_optical";
  processed.header.stamp = ros::Time(1600000000, 123456789);
  processed.reference_stamp = ros::Time(1599999999, 987654321);
  processed.camera = geometry::PinholeCamera{400.0, 410.0, 320.0, 240.0};
  processed.result.state = tracking::State::kTracking;
  processed.result.g = someHomography();
  processed.result.roi = {200.0, 150.0, 100.0, 80.0};
  processed.result.visible_fraction = 0.5;
  processed.result.zncc = 0.9;
  processed.result.corner_error = 0.25;
  processed.result.corner_scatter = 0.2;
  processed.result.centre_error = 0.125;
  processed.result.iterations = 12;
  using Cause = tracking::AreaCause;
  processed.result.areas = {
      2,
      3,
      {0.f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f},
      {false, false, true, false, true, true},
      {Cause::kNone, Cause::kNone, Cause::kColour, Cause::kNone, Cause::kHighlight, Cause::kBorder}};
  processed.processing_time = 0.003;
  return processed;
}

template <class Array>
Eigen::Matrix3d matrix(const Array& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

TEST(HomographyMessage, HasGAndHWithDeterminantOneRowByRow) {
  const Processed processed = tracked();
  const Homography message = homographyMessage(processed);
  EXPECT_EQ(matrix(message.g), processed.result.g);
  EXPECT_EQ(message.g[2], processed.result.g(0, 2));
  EXPECT_NEAR(matrix(message.g).determinant(), 1.0, 1e-12);
  ASSERT_TRUE(message.has_intrinsics);
  const Eigen::Matrix3d h = processed.camera->inverseMatrix() * processed.result.g * processed.camera->matrix();
  EXPECT_TRUE(matrix(message.h).isApprox(h, 1e-14));
  EXPECT_NEAR(matrix(message.h).determinant(), 1.0, 1e-12);
}

TEST(HomographyMessage, CopiesTheHeaderAndTheRest) {
  const Processed processed = tracked();
  const Homography message = homographyMessage(processed);
  EXPECT_EQ(message.header.stamp, processed.header.stamp);
  EXPECT_EQ(message.header.frame_id, processed.header.frame_id);
  EXPECT_EQ(message.reference_stamp, processed.reference_stamp);
  EXPECT_EQ(message.state, Homography::TRACKING);
  EXPECT_EQ(message.visible_fraction, 0.5);
  EXPECT_EQ(message.zncc, 0.9);
  EXPECT_EQ(message.corner_error, 0.25);
  EXPECT_EQ(message.centre_error, 0.125);
  EXPECT_EQ(message.iterations, 12);
  EXPECT_EQ(message.processing_time, 0.003);
  const geometry::Quadrilateral corners = geometry::apply(processed.result.g, processed.result.roi.corners());
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(message.corners[2 * k], corners[k].x());
    EXPECT_EQ(message.corners[2 * k + 1], corners[k].y());
  }
}

TEST(HomographyMessage, SaysThatHMeansNothingWithoutIntrinsics) {
  Processed processed = tracked();
  processed.camera.reset();
  const Homography message = homographyMessage(processed);
  EXPECT_FALSE(message.has_intrinsics);
  EXPECT_EQ(matrix(message.h), Eigen::Matrix3d::Identity());
  EXPECT_EQ(matrix(message.g), processed.result.g);
}

TEST(HomographyMessage, IsTheIdentityWhileIdle) {
  Processed processed;
  processed.camera = geometry::PinholeCamera{400.0, 410.0, 320.0, 240.0};
  const Homography message = homographyMessage(processed);
  EXPECT_EQ(message.state, Homography::IDLE);
  EXPECT_EQ(matrix(message.g), Eigen::Matrix3d::Identity());
  EXPECT_TRUE(matrix(message.h).isApprox(Eigen::Matrix3d::Identity()));
  for (const double corner : message.corners) EXPECT_EQ(corner, 0.0);
}

TEST(HomographyMessage, BoundsTheIterations) {
  Processed processed = tracked();
  processed.result.iterations = 100000;
  EXPECT_EQ(homographyMessage(processed).iterations, 65535);
}

TEST(TaskErrorMessage, IsZeroInTheReference) {
  Processed processed = tracked();
  processed.result.g.setIdentity();
  const TaskError message = taskErrorMessage(processed);
  ASSERT_TRUE(message.valid);
  EXPECT_EQ(message.header.stamp, processed.header.stamp);
  EXPECT_NEAR(message.e_v.x, 0.0, 1e-12);
  EXPECT_NEAR(message.e_w.z, 0.0, 1e-12);
  EXPECT_NEAR(message.x, message.desired_x, 1e-12);
  EXPECT_NEAR(message.log_depth, 0.0, 1e-12);
  // m* is the ROI's centre, (249.5, 189.5) px
  EXPECT_NEAR(message.m_star.x, (249.5 - 320.0) / 400.0, 1e-12);
  EXPECT_NEAR(message.m_star.y, (189.5 - 240.0) / 410.0, 1e-12);
  EXPECT_EQ(message.m_star.z, 1.0);
  EXPECT_EQ(message.visible_fraction, 0.5);
  EXPECT_EQ(message.corner_error, 0.2);
}

TEST(TaskErrorMessage, SeesAShiftToTheRight) {
  Processed processed = tracked();
  processed.result.g.setIdentity();
  processed.result.g(0, 2) = 40.0;  // px: 0.1 in normalised coordinates
  const TaskError message = taskErrorMessage(processed);
  ASSERT_TRUE(message.valid);
  EXPECT_NEAR(message.x - message.desired_x, 0.1, 1e-12);
  EXPECT_NEAR(message.y - message.desired_y, 0.0, 1e-12);
  EXPECT_NEAR(message.e_v.x, 0.1, 1e-12);
}

TEST(TaskErrorMessage, NamesItsRegionAlwaysAndIsInvalidUnlessTrackingWithIntrinsics) {
  for (const auto state : {tracking::State::kIdle, tracking::State::kSearching, tracking::State::kLost}) {
    Processed processed = tracked();
    processed.result.state = state;
    EXPECT_FALSE(taskErrorMessage(processed).valid);
    EXPECT_EQ(taskErrorMessage(processed).reference_stamp, processed.reference_stamp);
  }
  EXPECT_EQ(taskErrorMessage(tracked()).reference_stamp, tracked().reference_stamp);
  Processed blind = tracked();
  blind.camera.reset();
  EXPECT_FALSE(taskErrorMessage(blind).valid);
  EXPECT_TRUE(taskErrorMessage(tracked()).valid);
}

TEST(TaskErrorMessage, IsInvalidForWhatNoMotionExplains) {
  Processed broken = tracked();
  broken.result.g.setConstant(std::numeric_limits<double>::quiet_NaN());
  Processed mirrored = tracked();
  mirrored.result.g = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal();
  for (const Processed& processed : {broken, mirrored}) {
    const TaskError message = taskErrorMessage(processed);
    EXPECT_FALSE(message.valid);
    EXPECT_EQ(message.e_v.x, 0.0);
    EXPECT_EQ(message.log_depth, 0.0);
  }
}

TEST(AreaSelectionMessage, HasTheAreasRowByRow) {
  const AreaSelection message = areaSelectionMessage(tracked());
  EXPECT_EQ(message.rows, 2);
  EXPECT_EQ(message.columns, 3);
  EXPECT_EQ(message.distance, tracked().result.areas.distance);
  ASSERT_EQ(message.occluded.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(message.occluded[k] != 0, tracked().result.areas.occluded[k]);
  EXPECT_EQ(message.cause,
            (std::vector<std::uint8_t>{AreaSelection::NONE, AreaSelection::NONE, AreaSelection::COLOUR,
                                       AreaSelection::NONE, AreaSelection::HIGHLIGHT, AreaSelection::BORDER}));
}

TEST(RoiMessage, HasCornersOnlyOfARegionThatIsSomewhere) {
  const auto message = roiMessage(tracked());
  ASSERT_EQ(message.polygon.points.size(), 4u);
  EXPECT_FLOAT_EQ(message.polygon.points[1].x, static_cast<float>(homographyMessage(tracked()).corners[2]));
  EXPECT_EQ(message.polygon.points[1].z, 0.0f);
  EXPECT_EQ(message.header.frame_id, "laparoscope_optical");
  Processed idle;
  EXPECT_TRUE(roiMessage(idle).polygon.points.empty());
  Processed lost = tracked();
  lost.result.state = tracking::State::kLost;
  EXPECT_TRUE(roiMessage(lost).polygon.points.empty());
  Processed broken = tracked();
  broken.result.g.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(roiMessage(broken).polygon.points.empty());
}

TEST(ImageMessage, IsMonoOrColour) {
  const auto mask = imageMessage(tracked().header, cv::Mat(4, 6, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(mask->encoding, "mono8");
  EXPECT_EQ(mask->width, 6u);
  EXPECT_EQ(mask->height, 4u);
  EXPECT_EQ(mask->header.stamp, tracked().header.stamp);
  EXPECT_EQ(imageMessage(tracked().header, cv::Mat(4, 6, CV_8UC3))->encoding, "bgr8");
}

}  // namespace
}  // namespace laparoscope_servo
