#include "screen/space/instrument_shape.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/TrackedFeature.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "laparoscope_servo/model/cylinder_pose.h"

namespace laparoscope_servo::screen {
namespace {

const geometry::PinholeCamera kCamera{400.0, 410.0, 319.5, 239.5};
constexpr double kRadius = 0.0025;

const Eigen::Vector3d kTip(0.01, -0.005, 0.09);
const Eigen::Vector3d kAxis = Eigen::Vector3d(-0.6, 0.3, 0.4).normalized();
constexpr double kLength = 0.05;

QPointF pixelOf(const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = kCamera.matrix() * point;
  return {p.x() / p.z(), p.y() / p.z()};
}

FeatureFact poseWith(const Eigen::Matrix<double, 6, 6>& covariance) {
  FeatureFact pose;
  pose.kind = TrackedFeature::POSE;
  pose.radius = kRadius;
  const Eigen::AngleAxisd turn(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), kAxis));
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  pose.parameters = {kTip.x(), kTip.y(), kTip.z(), rotation.x(), rotation.y(), rotation.z()};
  pose.covariance.assign(covariance.data(), covariance.data() + 36);
  pose.outline << pixelOf(kTip - kLength * kAxis) << pixelOf(kTip);
  return pose;
}

// Turning about the axis is open, as in model::CylinderPose.
Eigen::Matrix<double, 6, 6> covariance(double across, double along, double turn) {
  Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
  const Eigen::Matrix3d aa = kAxis * kAxis.transpose(), rest = Eigen::Matrix3d::Identity() - aa;
  c.topLeftCorner<3, 3>() = across * across * rest + along * along * aa;
  c.bottomRightCorner<3, 3>() = turn * turn * rest + model::CylinderPose::kOpen * aa;
  return c;
}

double fromAxis(const Eigen::Vector3d& point) {
  return (point - kTip).cross(kAxis).norm();
}
double alongAxis(const Eigen::Vector3d& point) {
  return (point - kTip).dot(kAxis);
}

TEST(InstrumentShape, LiesFromWhereItEntersThePictureToItsTip) {
  const auto shape = instrumentShape(kCamera, poseWith(covariance(1e-4, 2e-4, 0.0)));
  ASSERT_TRUE(shape);
  EXPECT_LT((shape->end - kTip).norm(), 1e-9);
  EXPECT_LT((shape->entry - (kTip - kLength * kAxis)).norm(), 1e-9);
  EXPECT_EQ(shape->radius, kRadius);
  EXPECT_TRUE(shape->open_end.empty());
}

TEST(InstrumentShape, ItsSpreadIsTwiceTheStandardDeviations) {
  const auto shape = instrumentShape(kCamera, poseWith(covariance(1e-4, 5e-4, 0.0)));
  ASSERT_TRUE(shape && !shape->spread.empty());
  double furthest = -1.0;
  for (const auto& [from, to] : shape->spread) {
    EXPECT_NEAR(fromAxis(from), kRadius + 2e-4, 1e-7);
    furthest = std::max(furthest, alongAxis(from));
  }
  EXPECT_NEAR(furthest, 1e-3, 1e-7) << "beyond the tip by twice its deviation";
}

TEST(InstrumentShape, ADirectionThatIsNotKnownWidensItAwayFromTheTip) {
  const auto shape = instrumentShape(kCamera, poseWith(covariance(1e-4, 1e-4, 0.02)));
  ASSERT_TRUE(shape && !shape->spread.empty());
  for (const auto& [from, to] : shape->spread) {
    const double expected = kRadius + 2.0 * std::hypot(1e-4, 0.02 * alongAxis(from));
    EXPECT_NEAR(fromAxis(from), expected, 1e-6) << alongAxis(from);
  }
}

// Depth is worse known than what is across the line of sight.
TEST(InstrumentShape, AnUnequalCovarianceIsSeenInItsDirection) {
  Eigen::Matrix<double, 6, 6> c = covariance(1e-4, 1e-4, 0.0);
  const Eigen::Vector3d worst = kAxis.cross(Eigen::Vector3d::UnitZ()).cross(kAxis).normalized();
  c.topLeftCorner<3, 3>() += std::pow(2e-3, 2) * worst * worst.transpose();
  const auto shape = instrumentShape(kCamera, poseWith(c));
  ASSERT_TRUE(shape && !shape->spread.empty());
  double least = 1.0, most = 0.0;
  for (const auto& [from, to] : shape->spread) {
    least = std::min(least, fromAxis(from));
    most = std::max(most, fromAxis(from));
  }
  EXPECT_NEAR(least, kRadius + 2e-4, 1e-5);
  EXPECT_NEAR(most, kRadius + 2.0 * std::hypot(2e-3, 1e-4), 1e-5);
}

TEST(InstrumentShape, WhereSlidingIsOpenItHasNoEnd) {
  const auto shape = instrumentShape(kCamera, poseWith(covariance(1e-4, std::sqrt(model::CylinderPose::kOpen), 0.0)));
  ASSERT_TRUE(shape);
  ASSERT_FALSE(shape->open_end.empty());
  for (const auto& [from, to] : shape->open_end) EXPECT_GT(alongAxis(from), 0.0);
  ASSERT_FALSE(shape->spread.empty());
  for (const auto& [from, to] : shape->spread) {
    EXPECT_LT(alongAxis(from), 1e-6) << "no ring beyond what the image shows";
    EXPECT_NEAR(fromAxis(from), kRadius + 2e-4, 3e-5) << "and what is across is known as before";
  }
}

// As the tracker tells it, of the outline of a cylinder.
TEST(InstrumentShape, OfACylindersPose) {
  std::array<model::OutlineLine, 2> lines;
  const Eigen::Vector3d far = kTip - kLength * kAxis;
  for (std::size_t k = 0; k < 2; ++k) {
    // The plane through the camera's centre that touches the cylinder: its normal n has n . axis = 0, n . p = -radius.
    const Eigen::Vector3d foot = kTip - kAxis * kAxis.dot(kTip), side = kAxis.cross(foot).normalized();
    const double angle = std::asin(kRadius / foot.norm());
    const double sign = k == 0 ? 1.0 : -1.0;
    const Eigen::Vector3d normal = -std::sin(angle) * foot.normalized() + sign * std::cos(angle) * side;
    const Eigen::Vector3d line = kCamera.inverseMatrix().transpose() * normal;
    lines[k].theta = std::atan2(line.y(), line.x());
    lines[k].rho = -line.z() / line.head<2>().norm();
    lines[k].covariance << 0.01, 0.0, 0.0, 1e-8;
  }
  const QPointF tip = pixelOf(kTip);
  auto pose = model::cylinderPose(kCamera, kRadius, lines, Eigen::Vector2d(tip.x(), tip.y()), 4.0);
  if (pose && pose->direction.dot(kAxis) < 0.0) {
    std::swap(lines[0], lines[1]);  // right and left are of who looks towards the tip
    pose = model::cylinderPose(kCamera, kRadius, lines, Eigen::Vector2d(tip.x(), tip.y()), 4.0);
  }
  ASSERT_TRUE(pose);
  ASSERT_LT((pose->point - kTip).norm(), 1e-6);
  const auto shape = instrumentShape(kCamera, poseWith(pose->covariance));
  ASSERT_TRUE(shape);
  EXPECT_FALSE(shape->spread.empty()) << "though its turn about the axis is open";
  EXPECT_TRUE(shape->open_end.empty()) << "the tip closes sliding";
  EXPECT_LT((shape->entry - far).norm(), 1e-6);
}

TEST(InstrumentShape, IsNothingThatCannotBe) {
  const FeatureFact good = poseWith(covariance(1e-4, 1e-4, 0.0));
  const auto refused = [&good](const std::function<void(FeatureFact&)>& spoil) {
    FeatureFact pose = good;
    spoil(pose);
    return !instrumentShape(kCamera, pose);
  };
  EXPECT_FALSE(instrumentShape({}, good)) << "no camera";
  EXPECT_TRUE(refused([](FeatureFact& p) { p.radius = 0.0; })) << "no cylinder";
  EXPECT_TRUE(refused([](FeatureFact& p) { p.radius = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](FeatureFact& p) { p.kind = TrackedFeature::LINE; }));
  EXPECT_TRUE(refused([](FeatureFact& p) { p.parameters[2] = -0.1; })) << "behind the camera";
  EXPECT_TRUE(refused([](FeatureFact& p) { p.parameters[4] = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](FeatureFact& p) { p.parameters.pop_back(); }));
  EXPECT_TRUE(refused([](FeatureFact& p) { std::reverse(p.outline.begin(), p.outline.end()); })) << "no tip ahead";
  EXPECT_TRUE(refused([](FeatureFact& p) { p.outline.clear(); }));
  FeatureFact unknown = good;
  unknown.covariance.clear();
  ASSERT_TRUE(instrumentShape(kCamera, unknown));
  EXPECT_TRUE(instrumentShape(kCamera, unknown)->spread.empty());
  const auto vague = instrumentShape(kCamera, poseWith(covariance(10.0, 10.0, 0.0)));
  ASSERT_TRUE(vague);
  EXPECT_TRUE(vague->spread.empty()) << "metres are no knowledge";
}

}  // namespace
}  // namespace laparoscope_servo::screen
