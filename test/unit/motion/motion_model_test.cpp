#include "laparoscope_servo/motion/motion_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace laparoscope_servo::motion {
namespace {

MotionField randomField(std::mt19937& random, double size = 1.0) {
  std::normal_distribution<double> normal(0.0, size);
  MotionField field;
  field.centre = Eigen::Vector2d(319.5, 239.5);
  field.a << 5.0 * normal(random), 5.0 * normal(random), 0.02 * normal(random), 0.02 * normal(random),
      0.02 * normal(random), 0.02 * normal(random), 3e-5 * normal(random), 3e-5 * normal(random);
  return field;
}

// a of normalised points (metres at 1 m, by s): what a camera with the velocity (v, w) [m/s, rad/s] in its own frame
// sees of the plane Z = depth + g1 X + g2 Y [m] at rest.
geometry::Vector8d planeMotion(const Eigen::Vector3d& v, const Eigen::Vector3d& w, double depth, double g1, double g2) {
  geometry::Vector8d a;
  a << -v.x() / depth - w.y(),       // a0
      -v.y() / depth + w.x(),        // a1
      (g1 * v.x() + v.z()) / depth,  // a2
      g2 * v.x() / depth + w.z(),    // a3
      g1 * v.y() / depth - w.z(),    // a4
      (g2 * v.y() + v.z()) / depth,  // a5
      -g1 * v.z() / depth - w.y(),   // a6
      -g2 * v.z() / depth + w.x();   // a7
  return a;
}

TEST(MotionModel, CoefficientsAreThoseOfTheSurvey) {
  MotionField field;
  field.a << 1, 2, 3, 4, 5, 6, 7, 8;
  field.centre = Eigen::Vector2d(10.0, 20.0);
  // x = 2, y = 3: a0 + a2 x + a3 y + a6 x^2 + a7 x y, a1 + a4 x + a5 y + a6 x y + a7 y^2
  EXPECT_EQ(field.at({12.0, 23.0}), Eigen::Vector2d(1 + 6 + 12 + 28 + 48, 2 + 10 + 18 + 42 + 72));
}

TEST(MotionModel, EachModelHasItsParameters) {
  EXPECT_EQ(parametersOf(Model::kConstant), 2);
  EXPECT_EQ(parametersOf(Model::kAffine), 6);
  EXPECT_EQ(parametersOf(Model::kQuadratic), 8);
}

// Signs and coefficients: points of a plane before a camera that moves, by differences of their images.
TEST(MotionModel, IsWhatAMovingCameraSeesOfAPlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d v(unit(random), unit(random), unit(random)), w(unit(random), unit(random), unit(random));
    const double depth = 2.0 + unit(random), g1 = 0.5 * unit(random), g2 = 0.5 * unit(random);
    MotionField field;
    field.a = planeMotion(v, w, depth, g1, g2);
    const Eigen::Vector2d image(0.5 * unit(random), 0.5 * unit(random));
    const double z = depth / (1.0 - g1 * image.x() - g2 * image.y());
    const Eigen::Vector3d point = z * image.homogeneous();
    ASSERT_NEAR(point.z(), depth + g1 * point.x() + g2 * point.y(), 1e-12);
    // A scene point moves with -v - w x X in the camera's frame.
    constexpr double kStep = 1e-5;
    const Eigen::Vector3d moved = kStep * (-v - w.cross(point));
    const Eigen::Vector2d seen = ((point + moved).hnormalized() - (point - moved).hnormalized()) / (2.0 * kStep);
    EXPECT_LT((seen - field.at(image)).norm(), 1e-8) << "camera " << k;
  }
}

TEST(MotionModel, TheHomographyBeginsAsTheField) {
  std::mt19937 random(5);
  for (int k = 0; k < 20; ++k) {
    MotionField field = randomField(random);
    const Eigen::Vector2d p(600.0, 30.0), velocity = field.at(p);
    constexpr double kStep = 1e-4;
    field.a *= kStep;
    const Eigen::Matrix3d forward = homographyOf(field);
    field.a *= -1.0;
    const Eigen::Matrix3d backward = homographyOf(field);
    const Eigen::Vector2d seen = (geometry::apply(forward, p) - geometry::apply(backward, p)) / (2.0 * kStep);
    EXPECT_LT((seen - velocity).norm(), 1e-5 * velocity.norm());
  }
}

// Runge and Kutta's integration of eq. (8) over a unit of time.
TEST(MotionModel, TheHomographyIsTheFlowOfTheField) {
  std::mt19937 random(6);
  for (int k = 0; k < 20; ++k) {
    const MotionField field = randomField(random);
    Eigen::Vector2d p(40.0, 450.0);
    const Eigen::Vector2d expected = geometry::apply(homographyOf(field), p);
    constexpr int kSteps = 100;
    for (int i = 0; i < kSteps; ++i) {
      const double h = 1.0 / kSteps;
      const Eigen::Vector2d a = field.at(p), b = field.at(p + 0.5 * h * a), c = field.at(p + 0.5 * h * b);
      const Eigen::Vector2d d = field.at(p + h * c);
      p += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    EXPECT_LT((p - expected).norm(), 1e-7);
  }
}

TEST(MotionModel, FieldAndHomographyAreInverse) {
  std::mt19937 random(7);
  for (int k = 0; k < 50; ++k) {
    const MotionField field = randomField(random);
    const Eigen::Matrix3d g = homographyOf(field);
    EXPECT_NEAR(g.determinant(), 1.0, 1e-12);
    const MotionField back = fieldOf(g, field.centre);
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(back.a[i], field.a[i], 1e-10 * (1.0 + std::abs(field.a[i]))) << "a" << i;
  }
}

TEST(MotionModel, FewerParametersAreSubgroups) {
  std::mt19937 random(8);
  MotionField field = randomField(random);
  field.a.tail<2>().setZero();
  const Eigen::Matrix3d affine = homographyOf(field);
  EXPECT_LT(affine.row(2).head<2>().norm(), 1e-15);
  field.a.tail<6>().setZero();
  const Eigen::Matrix3d shift = homographyOf(field);
  EXPECT_LT((geometry::apply(shift, Eigen::Vector2d(7.0, 9.0)) - Eigen::Vector2d(7.0, 9.0) - field.a.head<2>()).norm(),
            1e-12);
}

TEST(MotionModel, DirectionsOfSl3AreTheModels) {
  const double unit = 320.0;
  const Eigen::Vector2d p(120.0, -50.0);
  for (int k = 0; k < 8; ++k) {
    constexpr double kStep = 1e-6;
    geometry::Vector8d x = geometry::Vector8d::Zero();
    x[k] = kStep;
    const Eigen::Vector2d seen = unit *
                                 (geometry::apply(geometry::sl3Exp(x), Eigen::Vector2d(p / unit)) -
                                  geometry::apply(geometry::sl3Exp(-x), Eigen::Vector2d(p / unit))) /
                                 (2.0 * kStep);
    const Eigen::Vector2d expected = fieldJacobian(p) * fieldFromSl3(unit).col(k);
    EXPECT_LT((seen - expected).norm(), 1e-6) << "direction " << k + 1;
  }
}

TEST(MotionModel, TheFieldsJacobianIsItsDerivative) {
  std::mt19937 random(10);
  MotionField field = randomField(random);
  const Eigen::Vector2d p(500.0, 100.0);
  const Eigen::Matrix<double, 2, 8> j = fieldJacobian(p - field.centre);
  for (int k = 0; k < 8; ++k) {
    MotionField more = field;
    more.a[k] += 1.0;
    EXPECT_LT((more.at(p) - field.at(p) - j.col(k)).norm(), 1e-9 * (1.0 + j.col(k).norm())) << "a" << k;
  }
}

// Of fields drawn by the covariance, where they move the corners.
TEST(MotionModel, TheErrorAtCornersIsThatOfTheWorstOne) {
  const Eigen::Vector2d centre(100.0, 80.0);
  const geometry::Quadrilateral corners = geometry::Rectangle{60.0, 50.0, 120.0, 100.0}.corners();
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  geometry::Vector8d deviations;
  deviations << 0.5, 0.2, 0.01, 0.003, 0.004, 0.006, 2e-5, 5e-5;
  Eigen::Matrix<double, 8, 8> mixed = Eigen::Matrix<double, 8, 8>::NullaryExpr([&] { return normal(random); });
  mixed = (deviations.asDiagonal() * mixed).eval();
  constexpr int kFields = 20000;
  std::array<double, 4> squares{};
  for (int k = 0; k < kFields; ++k) {
    MotionField field;
    field.centre = centre;
    field.a = mixed * geometry::Vector8d::NullaryExpr([&] { return normal(random); });
    for (std::size_t i = 0; i < 4; ++i) squares[i] += field.at(corners[i]).squaredNorm() / kFields;
  }
  const double worst = std::sqrt(*std::max_element(squares.begin(), squares.end()));
  EXPECT_NEAR(errorAtCorners(corners, centre, mixed * mixed.transpose()), worst, 0.03 * worst);
  EXPECT_EQ(errorAtCorners(corners, centre, Eigen::Matrix<double, 8, 8>::Zero()), 0.0);
}

TEST(MotionModel, AboutAnotherCentreItIsTheSameField) {
  MotionField field;
  field.centre = Eigen::Vector2d(40.0, 30.0);
  field.a << 3.0, -2.0, 0.012, 0.008, -0.010, 0.006, 2.5e-5, -2e-5;
  MotionField moved;
  moved.centre = Eigen::Vector2d(320.0, 240.0);
  moved.a = fieldAbout(moved.centre - field.centre) * field.a;
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(100.0, 7.0), Eigen::Vector2d(639.0, 479.0)})
    EXPECT_LT((field.at(pixel) - moved.at(pixel)).norm(), 1e-12) << pixel.transpose();
}

// The largest of four numbers, one of which is none, is none.
TEST(MotionModel, anErrorThatIsNotFiniteIsNotTakenForASmallOne) {
  const geometry::Quadrilateral corners = geometry::Rectangle{10.0, 20.0, 100.0, 80.0}.corners();
  const Eigen::Vector2d centre = geometry::Rectangle{10.0, 20.0, 100.0, 80.0}.centre();
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (int k = 0; k < 8; ++k) {
      Eigen::Matrix<double, 8, 8> covariance = Eigen::Matrix<double, 8, 8>::Identity() * 1e-6;
      covariance(k, k) = wrong;
      EXPECT_FALSE(errorAtCorners(corners, centre, covariance) < 1e300) << k;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::motion
