// The stages of PARALLEL, and each way in which they do not go on.
#include "servo/task/parallel/parallel_task.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <string>

#include "unit/servo/task/parallel/plane_scene.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kStep = 0.02;     // s, of poses and commands; an image with every second one
constexpr double kFarOff = 100.0;  // s

Workspace range() {
  Workspace workspace;
  workspace.axis = {0.0, 0.0, 1.0};  // z of the scene is into the body
  return workspace;
}

class ParallelTaskTest : public testing::Test {
 protected:
  ParallelTaskTest() { scene_.normal = PlaneScene::slanted(20.0 * kDegree, 1.0); }

  // An arm that does `late_` steps later what it is told, if it moves.
  void step() {
    const bool is_image = ++steps_ % 2 == 0;
    time_ += kStep;
    if (is_image) task_.see(time_, anchor_, scene_.view(), true);
    task_.move({time_, scene_.tip(), scene_.scope()}, commands_, kStep * static_cast<double>(late_));
    scope::Velocity velocity;
    if (task_.stage() == ParallelStage::kCircle) velocity = task_.circle(kStep);
    commands_.add(time_, velocity);
    told_.push_back(velocity);
    if (told_.size() <= late_) return;
    if (moving_) scene_.turn(kStep * told_.front().pan, kStep * told_.front().tilt);
    told_.pop_front();
  }
  void pass(double seconds) {
    for (const double end = time_ + seconds; time_ < end;) step();
  }
  bool isOnItsWay() const {
    return task_.stage() == ParallelStage::kCircle || task_.stage() == ParallelStage::kSettles;
  }
  // Until the circle has ended, and the arm stands; s.
  double goRound() {
    const double begun = time_;
    while (isOnItsWay() && time_ < begun + kFarOff) step();
    return time_ - begun;
  }
  void announce() {
    pass(0.5);
    task_.engage(time_);
    goRound();
    ASSERT_EQ(task_.stage(), ParallelStage::kAnnounced) << task_.problem();
  }

  PlaneScene scene_;
  ParallelConfig config_;
  ParallelTask task_{config_, range(), 0.08};
  CommandHistory commands_{5.0, 1.0};
  double time_ = 0.0, anchor_ = 1.0;
  std::deque<scope::Velocity> told_;  // not yet done
  std::size_t late_ = 0;              // steps
  int steps_ = 0;
  bool moving_ = true;
};

TEST_F(ParallelTaskTest, GoesRoundAnnouncesAndTurnsOnlyWhenEngagedAgain) {
  pass(0.5);
  EXPECT_EQ(task_.stage(), ParallelStage::kUnknown);
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kCircle);
  EXPECT_LT(goRound(), config_.period);
  ASSERT_EQ(task_.stage(), ParallelStage::kAnnounced) << task_.problem();
  EXPECT_NE(task_.announcement().find("ready to turn by "), std::string::npos);
  EXPECT_TRUE(task_.figures().normal.isApprox(scene_.normal, 5e-3));
  EXPECT_NEAR(task_.figures().distance, scene_.distance(), 5e-3);
  pass(2.0);
  EXPECT_EQ(task_.stage(), ParallelStage::kAnnounced) << "by itself it does not go on";
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kTurn);
  // The goal is to the side to which the normal points.
  step();
  EXPECT_TRUE(scene_.normalInCamera().isApprox(task_.figures().normal_in_camera, 5e-3));
  EXPECT_GT(task_.error().x * scene_.normalInCamera().x() + task_.error().y * scene_.normalInCamera().y(), 0.0);
}

// An arm that is late by 0.4 s goes on by 1.8 degrees after the circle.
TEST_F(ParallelTaskTest, AnnouncesFromWhereTheArmStands) {
  late_ = 20;
  pass(0.5);
  task_.engage(time_);
  while (task_.stage() == ParallelStage::kCircle) step();
  ASSERT_EQ(task_.stage(), ParallelStage::kSettles) << task_.problem();
  const Eigen::Matrix3d ended = scene_.base_R_shaft;
  goRound();
  ASSERT_EQ(task_.stage(), ParallelStage::kAnnounced) << task_.problem();
  EXPECT_GT(geometry::so3Log(ended.transpose() * scene_.base_R_shaft).norm(), 1.0 * kDegree);
  const std::string said = "ready to turn by ";
  ASSERT_EQ(task_.announcement().find(said), 0U) << task_.announcement();
  EXPECT_NEAR(std::stod(task_.announcement().substr(said.size())), scene_.slant() / kDegree, 0.7);
}

TEST_F(ParallelTaskTest, AnArmThatGoesOnIsNotAnnounced) {
  pass(0.5);
  task_.engage(time_);
  while (task_.stage() == ParallelStage::kCircle) step();
  ASSERT_EQ(task_.stage(), ParallelStage::kSettles) << task_.problem();
  for (int k = 0; k < 300; ++k) {
    step();
    EXPECT_NE(task_.stage(), ParallelStage::kAnnounced);
    scene_.turn(0.04 * kStep, 0.0);
  }
  EXPECT_EQ(task_.problem(), "the arm does not come to rest after the circle");
  EXPECT_EQ(task_.stage(), ParallelStage::kUnknown);
}

// What nobody was told is not turned to.
TEST_F(ParallelTaskTest, ACircleThatWasLeftBeginsAnew) {
  pass(0.5);
  task_.engage(time_);
  while (task_.stage() == ParallelStage::kCircle) step();
  ASSERT_EQ(task_.stage(), ParallelStage::kSettles) << task_.problem();
  task_.leaveCircle();
  pass(2.0);
  EXPECT_EQ(task_.stage(), ParallelStage::kUnknown);
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kCircle);
  announce();
  task_.leaveCircle();
  EXPECT_EQ(task_.stage(), ParallelStage::kAnnounced);
}

// It ends where it began, and is no larger than twice its radius.
TEST_F(ParallelTaskTest, TheCircleIsClosed) {
  pass(0.5);
  task_.engage(time_);
  const Eigen::Matrix3d begun = scene_.base_R_shaft;
  Eigen::Matrix3d r = begun;
  double most = 0.0;
  for (double t = 0.0; t < config_.period - 0.5 * kStep; t += kStep) {
    const scope::Velocity v = task_.circle(kStep);
    r = r * geometry::so3Exp({kStep * v.tilt, kStep * v.pan, 0.0});
    most = std::max(most, geometry::so3Log(begun.transpose() * r).norm());
  }
  EXPECT_LT(geometry::so3Log(begun.transpose() * r).head<2>().norm(), 0.1 * config_.radius);
  EXPECT_LT(most, 2.2 * config_.radius);
}

TEST_F(ParallelTaskTest, AnArmThatStandsMakesNoNormalKnown) {
  moving_ = false;
  scene_.noise = 0.3 / 400.0;
  pass(0.5);
  task_.engage(time_);
  EXPECT_NEAR(goRound(), config_.turns * config_.period, 0.1);
  EXPECT_NE(task_.problem().find("its slant shows too little"), std::string::npos) << task_.problem();
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kCircle) << "it begins anew";
  EXPECT_EQ(task_.problem(), "");
}

TEST_F(ParallelTaskTest, TooSlantedTissueIsRefused) {
  scene_.normal = PlaneScene::slanted(48.0 * kDegree, 1.0);
  pass(0.5);
  task_.engage(time_);
  goRound();
  EXPECT_NE(task_.problem().find("parallel/max_turn"), std::string::npos) << task_.problem();
}

// A frame of tf that is turned: what the arm tells is no motion that the picture shows.
TEST_F(ParallelTaskTest, PosesThatThePictureContradictsAreRefused) {
  pass(0.5);
  task_.engage(time_);
  for (int k = 0; k < 1000 && task_.stage() == ParallelStage::kCircle; ++k) {
    time_ += kStep;
    if (k % 2 == 0) task_.see(time_, anchor_, scene_.view(), true);
    // It tells the circle the wrong way round.
    Eigen::Isometry3d told = scene_.tip();
    const Eigen::Vector3d turned = geometry::so3Log(told.linear());
    told = scene_.tipAt(geometry::so3Exp({turned.x(), -turned.y(), 0.0}));
    task_.move({time_, told, scene_.scope()}, commands_, 0.0);
    if (task_.stage() != ParallelStage::kCircle) break;
    const scope::Velocity v = task_.circle(kStep);
    scene_.turn(kStep * v.pan, kStep * v.tilt);
  }
  EXPECT_EQ(task_.stage(), ParallelStage::kUnknown);
  EXPECT_NE(task_.problem(), "");
}

TEST_F(ParallelTaskTest, TissueThatTiltsStopsTheTurn) {
  announce();
  task_.engage(time_);
  pass(1.0);
  EXPECT_EQ(task_.stage(), ParallelStage::kTurn) << task_.problem();
  scene_.tilted = geometry::so3Exp({8.0 * kDegree, 0.0, 0.0});
  pass(1.0);
  EXPECT_NE(task_.problem().find("not where it was measured"), std::string::npos) << task_.problem();
}

TEST_F(ParallelTaskTest, AnOldAnnouncementOrOneFromElsewhereDoesNotCount) {
  announce();
  time_ += config_.keep + 1.0;
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kCircle);
  goRound();
  ASSERT_EQ(task_.stage(), ParallelStage::kAnnounced) << task_.problem();
  scene_.turn(0.1, 0.0);
  pass(0.2);
  task_.engage(time_);
  EXPECT_EQ(task_.stage(), ParallelStage::kCircle);
}

TEST_F(ParallelTaskTest, AnotherAnchorBeginsAnew) {
  announce();
  anchor_ = 2.0;
  pass(0.2);
  EXPECT_EQ(task_.stage(), ParallelStage::kUnknown);
  EXPECT_FALSE(task_.figures().is_known);
}

TEST_F(ParallelTaskTest, ImagesWithoutPosesMakeNothingKnown) {
  pass(0.5);
  task_.engage(time_);
  for (int k = 0; k < 1000 && task_.stage() == ParallelStage::kCircle; ++k) {
    time_ += kStep;
    task_.see(time_, anchor_, scene_.view(), true);
    task_.circle(kStep);
  }
  EXPECT_NE(task_.problem().find("poses and pictures did not come for the same time"), std::string::npos)
      << task_.problem();
}

}  // namespace
}  // namespace laparoscope_servo::servo
