// The model as a curve: Jacobians by differences, conventions, what is in the image.
#include "model/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/strands.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

const geometry::PinholeCamera kCamera{320.0, 300.0, 160.0, 120.0};
const cv::Size kSize(320, 240);

Outline outlineOf(const std::string& text, double distance = 0.5, double turn = 0.6) {
  const auto model = test::modelOf(text);
  return Outline(model, kCamera, kSize, test::viewOf(*model, distance, turn));
}

// How far the strand's picture is from a point along a normal, px, by the picture itself: from its points a and b next
// to the normal.
double distance(const Outline& outline, int strand, const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
  const Strands strands(outline.model());
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  const auto at = [&](double share) {
    const Eigen::Vector3d p =
        strands.isCircle(strand)
            ? circlePoint(outline.model().circles[static_cast<std::size_t>(strand - strands.edges - strands.sides)],
                          outline.pose(), 2.0 * M_PI * share)
                  .point
            : segment(outline.model(), outline.pose(), strand).at(share);
    return Eigen::Vector2d(project(outline.camera(), p) - point);
  };
  // The share nearest to the point, then Newton's steps until it lies on the normal.
  double share = 0.0;
  for (int k = 0; k < 400; ++k) {
    if (at(k / 400.0).norm() < at(share).norm()) share = k / 400.0;
  }
  for (int k = 0; k < 8; ++k) {
    const double slope = tangent.dot(at(share + 1e-6) - at(share - 1e-6)) / 2e-6;
    share -= tangent.dot(at(share)) / slope;
  }
  return normal.dot(at(share));
}

TEST(Outline, jacobiansOfEdgesSidesAndCirclesHoldByDifferences) {
  const Outline outline = outlineOf(test::kCubeAndTube);
  std::vector<features::Site> sites;
  outline.sites(6.0, 400, sites);
  ASSERT_GT(sites.size(), 60u);
  const Strands strands(outline.model());
  int kinds[3] = {0, 0, 0};
  for (const features::Site& site : sites) {
    const int strand = site.slot / (outline.slots() / strands.count());
    ++kinds[strands.isEdge(strand) ? 0 : strands.isCircle(strand) ? 2 : 1];
    EXPECT_NEAR(distance(outline, strand, site.point, site.normal), 0.0, 1e-5);
    for (int p = 0; p < 6; ++p) {
      constexpr double kStep = 1e-5;
      Eigen::VectorXd step = Eigen::VectorXd::Zero(6);
      step[p] = kStep;
      Outline more = outline, less = outline;
      more.move(step);
      less.move(-step);
      const double moved =
          (distance(more, strand, site.point, site.normal) - distance(less, strand, site.point, site.normal)) /
          (2.0 * kStep);
      const double told = site.jacobian[static_cast<std::size_t>(p)];
      EXPECT_NEAR(moved, told, 1e-3 * std::max(1.0, std::abs(told))) << "strand " << strand << ", parameter " << p;
    }
  }
  for (const int count : kinds) EXPECT_GT(count, 4);
}

// The survey's (7), as its interaction matrices are: a camera that moves to the right, v_x > 0, sees things go left.
TEST(Outline, theParametersAreTheTwistOfTheCamera) {
  const Outline outline = outlineOf(test::kCube);
  const Eigen::Vector2d before = project(kCamera, outline.centre());
  const auto after = [&](int p) {
    Outline moved = outline;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(6);
    step[p] = 0.01;
    moved.move(step);
    return moved;
  };
  EXPECT_LT(project(kCamera, after(0).centre()).x(), before.x() - 5.0);
  EXPECT_LT(project(kCamera, after(1).centre()).y(), before.y() - 5.0);
  EXPECT_NEAR(after(2).centre().z(), outline.centre().z() - 0.01, 1e-9);
  EXPECT_GT(project(kCamera, after(3).centre()).y(), before.y() + 2.0);
  EXPECT_LT(project(kCamera, after(4).centre()).x(), before.x() - 2.0);
}

// Translation of the object's origin and rotation about the camera's fixed axes, by the poses themselves.
TEST(Outline, poseInteractionHoldsByDifferences) {
  Outline outline = outlineOf(test::kCube);
  const Eigen::Isometry3d before = outline.pose();
  const geometry::Matrix6d interaction = poseInteraction(before);
  constexpr double kStep = 1e-6;
  for (Eigen::Index k = 0; k < 6; ++k) {
    outline.setPose(before);
    outline.move(kStep * Eigen::VectorXd::Unit(6, k));
    geometry::Vector6d moved;
    moved << outline.pose().translation() - before.translation(),
        geometry::so3Log(outline.pose().linear() * before.linear().transpose());
    EXPECT_LT((moved / kStep - interaction.col(k)).norm(), 1e-4) << k;
  }
}

TEST(Outline, pointInteractionHoldsByDifferences) {
  const Eigen::Vector3d point(0.1, -0.07, 0.6);
  const auto l = pointInteraction(kCamera, point);
  for (int p = 0; p < 6; ++p) {
    geometry::Vector6d step = geometry::Vector6d::Zero();
    step[p] = 1e-6;
    const Eigen::Vector2d moved = project(kCamera, geometry::se3Exp(step).inverse() * point) -
                                  project(kCamera, geometry::se3Exp(-step).inverse() * point);
    EXPECT_TRUE((moved / 2e-6).isApprox(l.col(p), 1e-4)) << p;
  }
}

// The curvature of a circle's picture against the circle through three neighbouring points.
TEST(Outline, theCurvatureOfACircleIsThatOfItsPicture) {
  const Outline outline = outlineOf(test::kCubeAndTube);
  std::vector<features::Site> sites;
  outline.sites(2.0, 1000, sites);
  const Strands strands(outline.model());
  const int first_slot = (strands.count() - 1) * (outline.slots() / strands.count());
  std::vector<features::Site> circle;
  for (const features::Site& site : sites) {
    if (site.slot >= first_slot) circle.push_back(site);
  }
  ASSERT_GT(circle.size(), 20u);
  int compared = 0;
  for (std::size_t k = 1; k + 1 < circle.size(); ++k) {
    const Eigen::Vector2d a = circle[k - 1].point, b = circle[k].point, c = circle[k + 1].point;
    if ((a - b).norm() > 5.0 || (c - b).norm() > 5.0) continue;
    const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    const double curvature = 2.0 * std::abs(area) / ((b - a).norm() * (c - b).norm() * (c - a).norm());
    EXPECT_NEAR(std::abs(circle[k].curvature), curvature, 0.1 * curvature + 1e-3);
    // The middle of the neighbours lies on the inner side.
    EXPECT_LT((0.5 * (a + c) - b).dot(circle[k].normal) * circle[k].curvature, 0.0);
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

TEST(Outline, sitesLieInTheImageInOrderAndNoMoreThanAsked) {
  for (const double distance : {0.15, 0.5, 3.0}) {
    const Outline outline = outlineOf(test::kCubeAndTube, distance);
    for (const int most : {16, 64, 200}) {
      std::vector<features::Site> sites;
      outline.sites(4.0, most, sites);
      EXPECT_LE(static_cast<int>(sites.size()), most);
      int before = -1;
      for (const features::Site& site : sites) {
        EXPECT_GE(site.point.x(), -1e-9);
        EXPECT_LE(site.point.x(), kSize.width - 1.0 + 1e-9);
        EXPECT_GE(site.point.y(), -1e-9);
        EXPECT_LE(site.point.y(), kSize.height - 1.0 + 1e-9);
        EXPECT_NEAR(site.normal.norm(), 1.0, 1e-12);
        EXPECT_GE(site.slot, before);
        EXPECT_LT(site.slot, outline.slots());
        before = site.slot;
      }
    }
  }
}

// A part of the model behind the camera: what is in front is drawn, nothing else.
TEST(Outline, anEdgeThatReachesBehindTheCameraIsDrawnAsFarAsItIsInFront) {
  const auto model = test::modelOf("V1\n2\n0 0.2 -1\n0 0.2 3\n1\n0 1\n0\n0\n0\n0\n");
  const Outline outline(model, kCamera, kSize, Eigen::Isometry3d::Identity());
  std::vector<features::Site> sites;
  outline.sites(4.0, 200, sites);
  ASSERT_GT(sites.size(), 5u);
  for (const features::Site& site : sites) {
    EXPECT_NEAR(site.point.x(), 160.0, 1e-9);
    EXPECT_GE(site.point.y(), 140.0 - 1e-9);
  }
}

// A similarity of the image: the centre goes where it is taken, and what is about it grows and turns.
TEST(Outline, aSimilarityOfTheImageMovesTheModelAlike) {
  const Outline outline = outlineOf(test::kCube);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
  const double turn = 0.1, growth = 1.1;
  motion.topLeftCorner<2, 2>() << growth * std::cos(turn), -growth * std::sin(turn), growth * std::sin(turn),
      growth * std::cos(turn);
  motion.topRightCorner<2, 1>() << 9.0, -14.0;
  Outline moved = outline;
  moved.transform(motion);
  const auto taken = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(motion.topLeftCorner<2, 2>() * p + motion.topRightCorner<2, 1>());
  };
  EXPECT_TRUE(project(kCamera, moved.centre()).isApprox(taken(project(kCamera, outline.centre())), 1e-9));
  for (const Eigen::Vector3d& point : outline.model().points) {
    const Eigen::Vector2d expected = taken(project(kCamera, outline.pose() * point));
    EXPECT_LT((project(kCamera, moved.pose() * point) - expected).norm(), 5.0);  // perspective and fx != fy remain
  }
}

// What is known is where the curve was expected: a step by the mean leads there.
TEST(Outline, whatIsKnownLeadsToTheExpectedPose) {
  const Outline expected = outlineOf(test::kCube);
  Outline here = expected;
  Eigen::VectorXd step(6);
  step << 0.004, -0.003, 0.006, 0.01, -0.008, 0.012;
  here.move(step);
  Eigen::MatrixXd information;
  Eigen::VectorXd mean;
  here.known(expected, 5.0, information, mean);
  EXPECT_GT(here.apart(expected.pose()), 2.0);
  here.move(mean);
  EXPECT_LT(here.apart(expected.pose()), 0.1);  // to first order
  // A sideways motion of the centre by the range has the weight of one standard deviation.
  const double sideways = 5.0 * here.centre().z() / (0.5 * (kCamera.fx + kCamera.fy));
  geometry::Vector6d shift = geometry::Vector6d::Zero();
  shift[0] = sideways;
  EXPECT_NEAR(shift.dot(information * shift), 1.0, 0.05);
}

TEST(Outline, isSoundInFrontOfTheCameraOnly) {
  Outline outline = outlineOf(test::kCube);
  EXPECT_TRUE(outline.isSound());
  Eigen::Isometry3d pose = outline.pose();
  pose.translation().z() -= 2.0;
  outline.setPose(pose);
  EXPECT_FALSE(outline.isSound());
  pose.translation().z() = std::nan("");
  outline.setPose(pose);
  EXPECT_FALSE(outline.isSound());
}

TEST(Outline, aPoseThatIsNotFiniteIsFarFromAnyOther) {
  const Outline outline = outlineOf(test::kCube);
  for (int k = 0; k < 12; ++k) {
    const bool aside = k == 9 || k == 10;  // which is no change of depth or direction
    for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      Eigen::Isometry3d pose = outline.pose();
      pose.matrix()(k % 3, k / 3) = wrong;
      EXPECT_TRUE(aside || !(outline.changeFrom(pose) < 1e300)) << k << ' ' << wrong;
      EXPECT_TRUE(!std::isnan(wrong) || !(outline.apart(pose) < 1e300)) << k;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::model
