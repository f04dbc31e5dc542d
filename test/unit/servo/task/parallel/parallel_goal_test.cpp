#include "servo/task/parallel/parallel_goal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "servo/task/scope_displacement.h"
#include "unit/servo/task/parallel/plane_scene.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kDepth = 0.08;  // m, Z*

Eigen::Vector3d axisOf(const Eigen::Matrix3d& camera_R_shaft) {
  return camera_R_shaft.transpose() * Eigen::Vector3d::UnitZ();
}

ParallelPlan planOf(const PlaneScene& scene, const Workspace& range = Workspace()) {
  Workspace into = range;
  into.axis = {0.0, 0.0, 1.0};  // z of the scene is into the body
  return planned({scene.normal, scene.distance()}, scene.tip(), scene.scope(), ParallelConfig(), into);
}

TEST(ParallelGoal, TheTurnBringsTheAxisOntoTheNormalWithoutSpin) {
  for (const double azimuth : {0.0, 1.0, 3.0, 5.0}) {
    const Eigen::Vector3d normal = PlaneScene::slanted(0.6, azimuth);
    const Eigen::Matrix3d turn = turnTo(normal, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE((turn * Eigen::Vector3d::UnitZ()).isApprox(normal, 1e-9));
    EXPECT_NEAR(geometry::so3Log(turn).z(), 0.0, 1e-12);
  }
  const Eigen::Vector3d axis = axisOf(scope::obliqueOptics(30.0 * kDegree, 1.0));
  for (const double azimuth : {0.0, 2.0, 4.0}) {
    const Eigen::Vector3d normal = geometry::so3Exp({0.0, 0.4, 0.0}) * PlaneScene::slanted(0.5, azimuth);
    EXPECT_TRUE((turnTo(normal, axis) * axis).isApprox(normal, 1e-9)) << azimuth;
  }
}

// The error is that of a point at rest: while the scope turns, it goes as the predictor says, and is 0 at the goal.
TEST(ParallelGoal, TheErrorIsThatOfAPointAtRest) {
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), scope::obliqueOptics(0.5, 0.4)}) {
    const scope::Geometry scope{optics, 0.1};
    const Eigen::Vector3d normal = geometry::so3Exp({0.2, 0.35, 0.0}) * axisOf(optics);
    const TaskError error = errorTowards(normal, scope, kDepth);
    const Eigen::Vector4d step(0.02, -0.01, 0.0, 0.0);
    const TaskError expected = moved(error, step, scope, kDepth);
    const Eigen::Vector3d now = geometry::so3Exp({0.01, -0.02, 0.0}) * normal;
    const TaskError after = errorTowards(now, scope, kDepth);
    const double bound = optics.isIdentity() ? 1e-12 : 5e-3;  // oblique: spin that remains turns the goal a little
    EXPECT_NEAR(after.x, expected.x, bound);
    EXPECT_NEAR(after.y, expected.y, bound);
    EXPECT_NEAR(after.log_depth, expected.log_depth, bound);
    const TaskError there = errorTowards(axisOf(optics), scope, kDepth);
    EXPECT_NEAR(there.x, 0.0, 1e-12);
    EXPECT_NEAR(there.y, 0.0, 1e-12);
    EXPECT_NEAR(there.log_depth, 0.0, 1e-12);
  }
}

TEST(ParallelGoal, ThePointToTheRightIsToTheRightInTheImage) {
  const scope::Geometry scope{Eigen::Matrix3d::Identity(), 0.1};
  EXPECT_GT(errorTowards(PlaneScene::slanted(0.3, 0.0), scope, kDepth).x, 0.0);
  EXPECT_GT(errorTowards(PlaneScene::slanted(0.3, 0.5 * M_PI), scope, kDepth).y, 0.0);
}

// 180 mm along the axis to the tissue, which is slanted by 30 degrees.
TEST(ParallelGoal, ThePlanTellsHowFarItGoes) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(30.0 * kDegree, 1.0);
  const ParallelPlan plan = planOf(scene);
  EXPECT_EQ(plan.problem, "");
  EXPECT_NEAR(plan.turn, 30.0 * kDegree, 1e-9);
  EXPECT_NEAR(plan.way, 0.18 * std::sin(30.0 * kDegree), 1e-9);
  EXPECT_NEAR(plan.distance, 0.08, 1e-9);
  EXPECT_NEAR(plan.remaining, 0.18 * std::cos(30.0 * kDegree) - 0.1, 1e-9);
  EXPECT_EQ(plan.words(),
            "ready to turn by 30 degrees: the view goes 90 mm over the tissue, which comes from 80 to 56 mm before the "
            "lens; engage to turn");
}

TEST(ParallelGoal, RefusesWhatCannotBeDone) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(45.0 * kDegree, 1.0);
  EXPECT_NE(planOf(scene).problem.find("parallel/max_turn"), std::string::npos) << planOf(scene).problem;
  scene.normal = PlaneScene::slanted(30.0 * kDegree, 1.0);
  scene.depth = 0.045;
  EXPECT_NE(planOf(scene).problem.find("parallel/min_distance"), std::string::npos) << planOf(scene).problem;
  scene.depth = 0.08;
  Workspace narrow;
  narrow.cone = 20.0 * kDegree;
  EXPECT_NE(planOf(scene, narrow).problem.find("range/cone"), std::string::npos) << planOf(scene, narrow).problem;
  scene.normal = -Eigen::Vector3d::UnitZ();
  EXPECT_NE(planOf(scene).problem, "");
  scene.normal = Eigen::Vector3d::Constant(std::nan(""));
  EXPECT_NE(planOf(scene).problem, "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
