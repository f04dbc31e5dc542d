#include "laparoscope_servo/geometry/homography.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::geometry {
namespace {

const PinholeCamera kCamera{400.0, 380.0, 319.5, 239.5};
const double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::Isometry3d anyMotion(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vector6d twist;
  for (int k = 0; k < 6; ++k) twist[k] = (k < 3 ? 0.03 : 0.4) * uniform(random);
  return se3Exp(twist);
}

Eigen::Vector3d anyNormal(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  return Eigen::Vector3d(uniform(random), uniform(random), 1.0).normalized();
}

TEST(Rectangle, CornersAreTheCentresOfTheCornerPixels) {
  const Rectangle roi{10.0, 20.0, 3.0, 5.0};  // pixels 10 to 12 and 20 to 24
  const Quadrilateral corners = roi.corners();
  EXPECT_EQ(corners[0], Eigen::Vector2d(10, 20));
  EXPECT_EQ(corners[1], Eigen::Vector2d(12, 20));
  EXPECT_EQ(corners[2], Eigen::Vector2d(12, 24));
  EXPECT_EQ(corners[3], Eigen::Vector2d(10, 24));
  EXPECT_EQ(roi.centre(), Eigen::Vector2d(11, 22));
  EXPECT_EQ(signedArea(corners), 8.0);
  EXPECT_TRUE(isConvex(corners));
}

TEST(Derivative, IsThatOfTheImageOfAPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Matrix3d g = fromPlane(anyMotion(random), anyNormal(random), 0.08);
    const Eigen::Vector2d p(uniform(random), uniform(random));
    const Eigen::Matrix2d j = derivative(g, p);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = 1e-6 * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope = (apply(g, Eigen::Vector2d(p + step)) - apply(g, Eigen::Vector2d(p - step))) / 2e-6;
      EXPECT_LT((j.col(axis) - slope).norm(), 1e-6 * (1.0 + slope.norm()));
    }
    EXPECT_TRUE(derivative(-3.0 * g, p).isApprox(j, 1e-12));  // whatever the scale
  }
}

// The convention of the whole package: H takes reference points to current points.
TEST(FromPlane, TakesReferencePointsToCurrentPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Isometry3d current_T_reference = anyMotion(random);
    const Eigen::Vector3d normal = anyNormal(random);
    const double distance = 0.08;
    const Eigen::Matrix3d h = fromPlane(current_T_reference, normal, distance);
    const Eigen::Vector3d ray(uniform(random), uniform(random), 1.0);
    const Eigen::Vector3d point = distance / normal.dot(ray) * ray;  // on the plane, in the reference frame
    const Eigen::Vector3d seen = current_T_reference * point;
    EXPECT_TRUE(
        geometry::apply(h, Eigen::Vector2d(ray.head<2>())).isApprox(Eigen::Vector2d(seen.head<2>() / seen.z()), 1e-12));
  }
}

TEST(FromPlane, MedianSingularValueIsOne) {
  std::mt19937 random(2);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Matrix3d h = fromPlane(anyMotion(random), anyNormal(random), 0.08);
    EXPECT_NEAR(Eigen::JacobiSVD<Eigen::Matrix3d>(h).singularValues()[1], 1.0, 1e-12);
  }
}

TEST(EuclideanScale, RestoresScaleAndSign) {
  std::mt19937 random(3);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Matrix3d h = fromPlane(anyMotion(random), anyNormal(random), 0.08);
    for (const double scale : {1.0, -1.0, 1e-9, -1e9}) {
      EXPECT_TRUE(euclideanScale(scale * h, Eigen::Vector3d(0.1, -0.2, 1.0)).isApprox(h, 1e-12));
    }
    EXPECT_TRUE(euclideanScale(normaliseDeterminant(h), Eigen::Vector3d::UnitZ()).isApprox(h, 1e-12));
  }
}

TEST(EuclideanScale, RefusesWhatIsNoImageOfAPlane) {
  EXPECT_THROW(euclideanScale(Eigen::Matrix3d::Zero(), Eigen::Vector3d::UnitZ()), std::invalid_argument);
  EXPECT_THROW(euclideanScale(Eigen::Vector3d(1, 0, 0).asDiagonal(), Eigen::Vector3d::UnitZ()), std::invalid_argument);
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Identity();
    h(k) = kNan;
    EXPECT_THROW(euclideanScale(h, Eigen::Vector3d::UnitZ()), std::invalid_argument);
  }
}

TEST(PixelsAndNormalised, AreInverseAndActOnThePoints) {
  std::mt19937 random(4);
  const Eigen::Matrix3d h = fromPlane(anyMotion(random), anyNormal(random), 0.08);
  const Eigen::Matrix3d g = pixelsFromNormalised(h, kCamera);
  EXPECT_TRUE(normalisedFromPixels(g, kCamera).isApprox(h, 1e-12));
  EXPECT_NEAR(g.determinant(), h.determinant(), 1e-9);
  const Eigen::Vector2d pixel(200.0, 300.0);
  const Eigen::Vector2d m = geometry::apply(kCamera.inverseMatrix(), pixel);
  EXPECT_TRUE(geometry::apply(g, pixel).isApprox(geometry::apply(kCamera.matrix(), geometry::apply(h, m)), 1e-9));
}

TEST(Apply, DoesNotDependOnScale) {
  Eigen::Matrix3d g;
  g << 1.1, 0.2, 5, -0.1, 0.9, -3, 0.001, -0.002, 1;
  const Eigen::Vector2d p(30.0, 40.0);
  EXPECT_TRUE(geometry::apply(g, p).isApprox(geometry::apply(Eigen::Matrix3d(-3.0 * g), p), 1e-14));
  const Quadrilateral q = Rectangle{0, 0, 50, 40}.corners();
  for (int k = 0; k < 4; ++k)
    EXPECT_TRUE(geometry::apply(g, q)[k].isApprox(geometry::apply(Eigen::Matrix3d(-3.0 * g), q)[k], 1e-12));
}

TEST(Apply, IsNotFiniteAtInfinity) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(2, 0) = -0.01;  // u = 100 goes to infinity
  EXPECT_FALSE(geometry::apply(g, Eigen::Vector2d(100.0, 10.0)).allFinite());
  const Quadrilateral through = geometry::apply(g, Rectangle{50, 0, 101, 10}.corners());
  for (const Eigen::Vector2d& corner : through) {
    EXPECT_FALSE(corner.allFinite());
    EXPECT_TRUE(std::isnan(corner.x()) && std::isnan(corner.y()));
  }
  EXPECT_FALSE(isConvex(through));
  EXPECT_TRUE(isConvex(geometry::apply(g, Rectangle{0, 0, 90, 10}.corners())));
}

TEST(SignedArea, ChangesSignWithTheSenseOfTheTurn) {
  const Quadrilateral q = Rectangle{3, 4, 11, 21}.corners();
  EXPECT_EQ(signedArea(q), 200.0);
  EXPECT_EQ(signedArea({q[0], q[3], q[2], q[1]}), -200.0);
}

TEST(LargestDistance, OfWhatIsNotFiniteIsInfinite) {
  const Quadrilateral a = Rectangle{10.0, 20.0, 30.0, 40.0}.corners();
  Quadrilateral b = a;
  b[2] += Eigen::Vector2d(3.0, 4.0);
  EXPECT_NEAR(largestDistance(a, b), 5.0, 1e-12);
  for (const double lost : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      Quadrilateral c = b;
      c[k].x() = lost;
      EXPECT_EQ(largestDistance(a, c), std::numeric_limits<double>::infinity()) << k;
      EXPECT_EQ(largestDistance(c, a), std::numeric_limits<double>::infinity()) << k;
    }
  }
}

TEST(CornerDistance, IsInfiniteWhereThereIsNoImage) {
  const Rectangle roi{100, 80, 101, 61};
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() << 3.0, -4.0;
  EXPECT_NEAR(cornerDistance(Eigen::Matrix3d::Identity(), shift, roi), 5.0, 1e-12);
  Eigen::Matrix3d through_infinity = Eigen::Matrix3d::Identity();
  through_infinity(2, 0) = -1.0 / 150.0;  // the line x = 150 crosses the rectangle
  EXPECT_EQ(cornerDistance(Eigen::Matrix3d::Identity(), through_infinity, roi),
            std::numeric_limits<double>::infinity());
}

TEST(IsConvex, RefusesWhatNoRectangleLooksLike) {
  using V = Eigen::Vector2d;
  EXPECT_TRUE(isConvex({V(0, 0), V(10, 1), V(9, 11), V(-1, 8)}));
  EXPECT_FALSE(isConvex({V(0, 0), V(0, 10), V(10, 10), V(10, 0)})) << "mirrored";
  EXPECT_FALSE(isConvex({V(0, 0), V(10, 0), V(2, 2), V(0, 10)})) << "dented";
  EXPECT_FALSE(isConvex({V(0, 0), V(10, 10), V(10, 0), V(0, 10)})) << "crossed";
  EXPECT_FALSE(isConvex({V(0, 0), V(5, 0), V(10, 0), V(0, 10)})) << "three on a line";
  EXPECT_FALSE(isConvex({V(1, 1), V(1, 1), V(1, 1), V(1, 1)})) << "a point";
  EXPECT_FALSE(isConvex({V(0, 0), V(10, 0), V(10, kNan), V(0, 10)})) << "not finite";
}

TEST(FromCorners, TakesCornersToCorners) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-20.0, 20.0);
  const Quadrilateral from = Rectangle{150, 100, 120, 90}.corners();
  for (int n = 0; n < 200; ++n) {
    Quadrilateral to = from;
    for (Eigen::Vector2d& corner : to) corner += Eigen::Vector2d(uniform(random), uniform(random));
    const Eigen::Matrix3d g = fromCorners(from, to);
    EXPECT_NEAR(g.determinant(), 1.0, 1e-9);
    const Quadrilateral seen = geometry::apply(g, from);
    for (int k = 0; k < 4; ++k) EXPECT_LT((seen[k] - to[k]).norm(), 1e-8);
  }
}

TEST(PixelsFromPlane, TakesEachPointOfThePlaneToWhereItIsSeen) {
  std::mt19937 random(8);
  for (int n = 0; n < 50; ++n) {
    const Eigen::Isometry3d current_T_reference = anyMotion(random);
    const Eigen::Vector3d normal = anyNormal(random);
    const Eigen::Matrix3d g = pixelsFromPlane(current_T_reference, normal, 0.08, kCamera);
    EXPECT_NEAR(g.determinant(), 1.0, 1e-9);
    for (const Eigen::Vector2d& p : Rectangle{270, 190, 100, 100}.corners()) {
      const Eigen::Vector3d ray = kCamera.inverseMatrix() * p.homogeneous();
      const Eigen::Vector3d point = current_T_reference * Eigen::Vector3d(0.08 / normal.dot(ray) * ray);
      const Eigen::Vector2d seen = (kCamera.matrix() * point).hnormalized();
      EXPECT_TRUE(geometry::apply(g, p).isApprox(seen, 1e-9));
    }
  }
}

TEST(PixelsFromPlane, MovesThePictureAgainstTheCamera) {
  // 1 cm to the right, 8 cm in front of the plane: what was in the middle is now 1/8 of the focal length to the left.
  Eigen::Isometry3d current_T_reference = Eigen::Isometry3d::Identity();
  current_T_reference.translation().x() = -0.01;
  const Eigen::Matrix3d g = pixelsFromPlane(current_T_reference, Eigen::Vector3d::UnitZ(), 0.08, kCamera);
  const Eigen::Vector2d seen = geometry::apply(g, Eigen::Vector2d(kCamera.cx, kCamera.cy));
  EXPECT_NEAR(seen.x(), kCamera.cx - kCamera.fx / 8.0, 1e-9);
  EXPECT_NEAR(seen.y(), kCamera.cy, 1e-9);
}

TEST(PixelsFromPlane, RefusesWhatNoPlaneIsSeenBy) {
  const Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (const double bad : {0.0, -0.08, kNan})
    EXPECT_THROW(pixelsFromPlane(motion, n, bad, kCamera), std::invalid_argument);
  motion.translation().z() = -0.09;
  EXPECT_THROW(pixelsFromPlane(motion, n, 0.08, kCamera), std::invalid_argument) << "through the plane";
  motion.translation().z() = kNan;
  EXPECT_THROW(pixelsFromPlane(motion, n, 0.08, kCamera), std::invalid_argument);
}

TEST(FromCorners, RecoversTheHomography) {
  std::mt19937 random(6);
  for (int n = 0; n < 100; ++n) {
    const Eigen::Matrix3d g =
        normaliseDeterminant(pixelsFromNormalised(fromPlane(anyMotion(random), anyNormal(random), 0.08), kCamera));
    const Quadrilateral from = Rectangle{270, 190, 100, 100}.corners();
    EXPECT_TRUE(fromCorners(from, geometry::apply(g, from)).isApprox(g, 1e-8));
  }
  const Quadrilateral q = Rectangle{270, 190, 100, 100}.corners();
  EXPECT_TRUE(fromCorners(q, q).isApprox(Eigen::Matrix3d::Identity(), 1e-9));
}

TEST(FromCorners, RefusesThreeCornersOnALine) {
  using V = Eigen::Vector2d;
  const Quadrilateral good = Rectangle{0, 0, 100, 100}.corners();
  const Quadrilateral line{V(0, 0), V(50, 50), V(100, 100), V(0, 100)};
  const Quadrilateral last_on_line{V(0, 0), V(100, 0), V(100, 100), V(50, 50)};
  Quadrilateral nan = good;
  nan[2].y() = kNan;
  for (const Quadrilateral& bad : {line, last_on_line, nan}) {
    EXPECT_THROW(fromCorners(good, bad), std::invalid_argument);
    EXPECT_THROW(fromCorners(bad, good), std::invalid_argument);
  }
}

}  // namespace
}  // namespace laparoscope_servo::geometry
