#include "laparoscope_servo/servo/task_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

using geometry::PinholeCamera;
using geometry::Rectangle;

const PinholeCamera kCamera{400.0, 380.0, 319.5, 239.5};
const Rectangle kCentred{269.5 + 0.5, 189.5 + 0.5, 100.0, 100.0};  // its centre is the principal point
const Rectangle kOffCentre{150.0, 220.0, 90.0, 70.0};
const double kDepth = 0.08;

// H after the camera has moved by reference_T_current from the reference pose, before a plane across the optical axis.
Eigen::Matrix3d homographyAfter(const Eigen::Isometry3d& reference_T_current) {
  return geometry::fromPlane(reference_T_current.inverse(), Eigen::Vector3d::UnitZ(), kDepth);
}

Eigen::Isometry3d turned(double x, double y, double z) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = geometry::so3Exp({x, y, z});
  return motion;
}

Eigen::Isometry3d moved(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(TaskFunction, IsZeroAtTheReference) {
  for (const Rectangle& roi : {kCentred, kOffCentre}) {
    const TaskError error = taskError(Eigen::Matrix3d::Identity(), roi, kCamera);
    EXPECT_NEAR(error.e_v.norm(), 0.0, 1e-15);
    EXPECT_NEAR(error.e_w.norm(), 0.0, 1e-15);
    EXPECT_NEAR(error.x, error.desired_x, 1e-15);
    EXPECT_NEAR(error.y, error.desired_y, 1e-15);
    EXPECT_NEAR(error.log_depth, error.desired_log_depth, 1e-15);
    EXPECT_NEAR(error.alpha, error.desired_alpha, 1e-15);
    EXPECT_EQ(error.m_star.z(), 1.0);
  }
}

TEST(TaskFunction, CentreIsNormalisedWithTheIntrinsics) {
  const TaskError error = taskError(Eigen::Matrix3d::Identity(), kOffCentre, kCamera);
  EXPECT_NEAR(error.m_star.x(), (150.0 + 44.5 - 319.5) / 400.0, 1e-15);
  EXPECT_NEAR(error.m_star.y(), (220.0 + 34.5 - 239.5) / 380.0, 1e-15);
  EXPECT_EQ(error.desired_x, error.m_star.x());
  EXPECT_EQ(error.desired_y, error.m_star.y());
}

// The convention that the stable law v = +lambda e_v relies on: e_v points back to where the camera came from.
TEST(TaskFunction, TranslationErrorPointsBackToTheReference) {
  for (const Rectangle& roi : {kCentred, kOffCentre}) {
    for (const Eigen::Vector3d& motion :
         {Eigen::Vector3d(0.01, 0, 0), Eigen::Vector3d(0, 0.01, 0), Eigen::Vector3d(0, 0, 0.01)}) {
      const TaskError error = taskError(homographyAfter(moved(motion.x(), motion.y(), motion.z())), roi, kCamera);
      EXPECT_NEAR((error.e_v + motion / kDepth).norm(), 0.0, 1e-12);
      EXPECT_NEAR(error.e_w.z(), 0.0, 1e-12);
    }
  }
}

TEST(TaskFunction, RotationErrorPointsBackToTheReference) {
  for (const double angle : {0.01, 0.3, 1.2, -0.7}) {
    for (int axis = 0; axis < 3; ++axis) {
      // About x and y only as far as the ROI stays in front of the camera.
      const double turn = axis == 2 ? angle : 0.5 * angle;
      Eigen::Vector3d expected = Eigen::Vector3d::Zero();
      expected[axis] = -2.0 * std::sin(turn);
      const TaskError error = taskError(
          homographyAfter(turned(axis == 0 ? turn : 0, axis == 1 ? turn : 0, axis == 2 ? turn : 0)), kCentred, kCamera);
      EXPECT_NEAR((error.e_w - expected).norm(), 0.0, 1e-12) << "axis " << axis << ", angle " << turn;
    }
  }
}

TEST(TaskFunction, FeaturesFollowTheImage) {
  // Camera to the right: tissue to the left; down: up; deeper: larger and nearer; clockwise: tissue counter-clockwise.
  EXPECT_NEAR(taskError(homographyAfter(moved(0.01, 0, 0)), kCentred, kCamera).x, -0.125, 1e-12);
  EXPECT_NEAR(taskError(homographyAfter(moved(0, 0.01, 0)), kCentred, kCamera).y, -0.125, 1e-12);
  EXPECT_NEAR(taskError(homographyAfter(moved(0, 0, 0.02)), kOffCentre, kCamera).log_depth, std::log(0.75), 1e-12);
  EXPECT_NEAR(taskError(homographyAfter(moved(0, 0, -0.08)), kOffCentre, kCamera).log_depth, std::log(2.0), 1e-12);
  for (const double spin : {0.1, 1.5, 3.0, -3.0}) {
    EXPECT_NEAR(taskError(homographyAfter(turned(0, 0, spin)), kOffCentre, kCamera).alpha, -spin, 1e-12);
  }
}

// alpha's row of the interaction matrix, on the axis: (0, 0, 0, 0, 0, -1).
TEST(TaskFunction, OrientationOnTheAxisFeelsOnlySpin) {
  const double step = 1e-6;
  for (int k = 0; k < 6; ++k) {
    geometry::Vector6d twist = geometry::Vector6d::Zero();
    twist[k] = step;
    const double rate = taskError(homographyAfter(geometry::se3Exp(twist)), kCentred, kCamera).alpha / step;
    EXPECT_NEAR(rate, k == 5 ? -1.0 : 0.0, 1e-4) << "component " << k;
  }
}

TEST(TaskFunction, DoesNotDependOnScaleOrSignOfH) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    geometry::Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = (i < 3 ? 0.02 : 0.2) * uniform(random);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.5 * uniform(random), 0.5 * uniform(random), 1.0).normalized();
    const Eigen::Matrix3d h = geometry::fromPlane(geometry::se3Exp(twist), normal, kDepth);
    const TaskError expected = taskError(h, kOffCentre, kCamera);
    EXPECT_NEAR((expected.e_v - (h - Eigen::Matrix3d::Identity()) * expected.m_star).norm(), 0.0, 1e-12);
    for (const double scale : {-1.0, 1e-6, -37.0, 1e8}) {
      const TaskError error = taskError(scale * h, kOffCentre, kCamera);
      EXPECT_NEAR((error.e_v - expected.e_v).norm(), 0.0, 1e-12);
      EXPECT_NEAR((error.e_w - expected.e_w).norm(), 0.0, 1e-12);
      EXPECT_NEAR(error.x, expected.x, 1e-12);
      EXPECT_NEAR(error.log_depth, expected.log_depth, 1e-12);
      EXPECT_NEAR(error.alpha, expected.alpha, 1e-12);
    }
  }
}

TEST(TaskFunction, RefusesWhatIsNoViewOfTheRoi) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d h = identity;
    h(k) = nan;
    EXPECT_THROW(taskError(h, kCentred, kCamera), std::invalid_argument) << k;
    h(k) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(taskError(h, kCentred, kCamera), std::invalid_argument) << k;
  }
  EXPECT_THROW(taskError(Eigen::Matrix3d::Zero(), kCentred, kCamera), std::invalid_argument);
  const Eigen::Matrix3d plane_seen_edge_on = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_THROW(taskError(plane_seen_edge_on, kCentred, kCamera), std::invalid_argument);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_THROW(taskError(mirror, kCentred, kCamera), std::invalid_argument);
  const Rectangle corner{600.0, 220.0, 30.0, 30.0};
  const Eigen::Isometry3d behind =
      turned(0.0, -1.2, 0.0);  // the corner's ray turned to more than 90 degrees off the axis
  EXPECT_THROW(taskError(behind.linear().transpose(), corner, kCamera), std::invalid_argument);
  EXPECT_THROW(taskError(homographyAfter(turned(0.0, 1.5, 0.0)), kCentred, kCamera),
               std::invalid_argument);  // through infinity
}

TEST(TaskFunction, RefusesBadRoiAndCamera) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  for (const Rectangle& roi : {Rectangle{0, 0, 1, 100}, Rectangle{0, 0, 100, 0}, Rectangle{nan, 0, 100, 100},
                               Rectangle{0, nan, 100, 100}, Rectangle{0, 0, nan, 100}, Rectangle{0, 0, 100, -5}}) {
    EXPECT_THROW(taskError(identity, roi, kCamera), std::invalid_argument);
  }
  EXPECT_THROW(taskError(identity, kCentred, PinholeCamera{}), std::invalid_argument);
  EXPECT_THROW(taskError(identity, kCentred, PinholeCamera{nan, 400, 320, 240}), std::invalid_argument);
}

TEST(TaskFunction, FinitenessLooksAtEveryNumber) {
  const TaskError good = taskError(Eigen::Matrix3d::Identity(), kCentred, kCamera);
  EXPECT_TRUE(isFinite(good));
  double TaskError::*const scalars[] = {
      &TaskError::x,         &TaskError::y,         &TaskError::log_depth,         &TaskError::alpha,
      &TaskError::desired_x, &TaskError::desired_y, &TaskError::desired_log_depth, &TaskError::desired_alpha};
  for (double TaskError::*const scalar : scalars) {
    TaskError bad = good;
    bad.*scalar = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(isFinite(bad));
  }
  Eigen::Vector3d TaskError::*const vectors[] = {&TaskError::e_v, &TaskError::e_w, &TaskError::m_star};
  for (Eigen::Vector3d TaskError::*const vector : vectors) {
    for (int k = 0; k < 3; ++k) {
      TaskError bad = good;
      (bad.*vector)[k] = std::numeric_limits<double>::infinity();
      EXPECT_FALSE(isFinite(bad));
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
