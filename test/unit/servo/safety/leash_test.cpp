#include "servo/safety/leash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "servo/task/scope_displacement.h"
#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::PlaneLoop;

// A scope before a plane; what is seen may be changed on its way.
class Watched {
 public:
  explicit Watched(const scope::Velocity& start, double believed_depth = test::kZ) : believed_depth_(believed_depth) {
    move(start);
  }

  // The scope moves by `displacement`, and the picture then comes.
  void step(const scope::Velocity& displacement = scope::Velocity()) {
    move(displacement);
    LeashObservation image;
    image.time = time_ += 0.04;
    image.region = region;
    image.error = loop_.error();
    image.error.x += aside;
    image.error.alpha += turned;
    image.error.log_depth += further;
    image.to_target = displacementToTarget(image.error, loop_.scope(), believed_depth_);
    image.d2 = loop_.scope().d2;
    if (pose) image.insertion_point_T_tip = Eigen::Isometry3d(shaft_);
    leash.observe(image);
  }
  // In steps, to where the region seems to be in its place.
  void follow(int steps, double share = 0.2) {
    for (int k = 0; k < steps; ++k) {
      TaskError error = loop_.error();
      error.x += aside;
      error.alpha += turned;
      error.log_depth += further;
      step(scope::Velocity::fromVector(share * displacementToTarget(error, loop_.scope(), believed_depth_)));
    }
  }

  Leash leash{LeashConfig()};
  double aside = 0.0, turned = 0.0, further = 0.0;  // of the picture
  std::optional<double> region = 1.0;
  bool pose = true;

 private:
  void move(const scope::Velocity& displacement) {
    loop_.offset(displacement);
    shaft_ = shaft_ * geometry::so3Exp(scope::angularVelocity(displacement));
  }

  double believed_depth_;
  PlaneLoop loop_{Eigen::Vector3d::UnitZ(), test::kZ, test::straight()};
  Eigen::Matrix3d shaft_ = Eigen::Matrix3d::Identity();
  double time_ = 0.0;
};

TEST(Leash, TissueAtRestStaysWhereItIsWhateverTheScopeDoes) {
  for (const scope::Velocity& start : {scope::Velocity{0.2, 0.1, 0.5, 0.02}, scope::Velocity{-0.1, 0.2, -0.7, -0.02}}) {
    Watched scope(start);
    scope.follow(60);
    EXPECT_EQ(scope.leash.words(), "");
    EXPECT_LT(scope.leash.used(), 0.02);
    // Seen from the side, the region's area is a little less than its depth would make it.
    for (int k = 0; k < 20; ++k) scope.step({0.005, -0.003, 0.01, 0.0003});
    EXPECT_EQ(scope.leash.words(), "");
    EXPECT_LT(scope.leash.used(), 0.2);
  }
}

TEST(Leash, WrongDepthsAreBorneOnTheWay) {
  for (const double believed : {0.5, 2.0}) {
    Watched scope({0.15, -0.1, 0.3, 0.02}, believed * test::kZ);
    for (int k = 0; k < 80; ++k) {
      scope.follow(1, 0.1);
      ASSERT_EQ(scope.leash.words(), "") << believed << ", step " << k;
    }
  }
}

TEST(Leash, APictureThatTurnsIsFollowedOnlySoFar) {
  Watched scope({});
  scope.step();
  double turned = 0.0;
  while (scope.leash.words().empty() && turned < 1.0) {
    scope.turned = turned += 0.005;
    scope.follow(1, 0.5);
  }
  EXPECT_NEAR(turned, LeashConfig().spin, 0.01);
  EXPECT_EQ(scope.leash.words(), "the view has wandered too far about the shaft: look at the picture");
  // It stays so, whether the scope stands or follows, until the picture is back.
  scope.follow(40);
  EXPECT_NE(scope.leash.words(), "");
  scope.turned = 0.95 * LeashConfig().spin;
  scope.follow(1);
  EXPECT_NE(scope.leash.words(), "");
  scope.turned = 0.8 * LeashConfig().spin;
  scope.follow(1);
  EXPECT_EQ(scope.leash.words(), "");
}

TEST(Leash, APictureThatRunsAsideIsFollowedOnlySoFar) {
  Watched scope({});
  scope.step();
  double run = 0.0;
  for (; scope.leash.words().empty() && run < 3.0; run += 0.005) {
    scope.aside = run;
    scope.follow(1, 0.5);
  }
  // The picture's shift turns the scope by what it takes at the insertion point: Z / (Z + d2) of it.
  const double turn = run * test::kZ / (test::kZ + test::kD2);
  EXPECT_NEAR(turn, LeashConfig().turn, 0.03);
  EXPECT_EQ(scope.leash.words(), "the view has wandered too far sideways: look at the picture");
}

TEST(Leash, AZoomIsNoticedSoonerWhenItIsQuick) {
  const auto bornTo = [](double step) {
    Watched scope({});
    for (int k = 0; k < 100; ++k) scope.step();
    double further = 0.0;
    while (scope.leash.words().empty() && further < 1.0) {
      scope.further = further += step;
      scope.follow(1, 0.5);
    }
    EXPECT_NE(scope.leash.words().find("along the shaft"), std::string::npos);
    return test::kZ * (1.0 - std::exp(-further));  // the way that the scope would have to go in
  };
  EXPECT_NEAR(bornTo(0.01), LeashConfig().quick_insertion, 0.002);
  EXPECT_NEAR(bornTo(0.0003), LeashConfig().insertion, 0.002);
}

TEST(Leash, ABreathIsBorneForHours) {
  Watched scope({});
  for (int k = 0; k < 20000; ++k) {
    const double breath = std::sin(0.25 * 2.0 * M_PI * 0.04 * k);
    scope.aside = 0.09 * breath;
    scope.further = 0.03 * breath;
    scope.follow(1, 0.5);
    ASSERT_EQ(scope.leash.words(), "") << k;
  }
}

TEST(Leash, BeginsAnewWithAnotherRegionAnotherViewAndOnDemand) {
  const auto wandered = [] {
    Watched scope({});
    scope.step();
    scope.turned = 0.3;
    scope.step();
    EXPECT_NE(scope.leash.words(), "");
    return scope;
  };
  Watched other = wandered();
  other.region = 2.0;
  other.step();
  EXPECT_EQ(other.leash.words(), "");
  Watched restarted = wandered();
  restarted.leash.restart();
  EXPECT_EQ(restarted.leash.words(), "");
  restarted.step();
  EXPECT_EQ(restarted.leash.words(), "");
  restarted.step();
  EXPECT_LT(restarted.leash.used(), 1e-6);
}

TEST(Leash, AnotherDesiredViewIsNoWandering) {
  Leash leash{LeashConfig()};
  LeashObservation image;
  const auto see = [&](double desired, double to_go) {
    image.time += 0.04;
    image.error.desired_log_depth = desired;
    image.to_target[3] = to_go;
    image.d2 = 0.1;
    leash.observe(image);
    return leash.words();
  };
  EXPECT_EQ(see(0.0, 0.0), "");
  EXPECT_EQ(see(0.3, 0.02), "");
  EXPECT_EQ(see(0.3, 0.02), "");
  EXPECT_NE(see(0.3, 0.06), "");
}

TEST(Leash, WithoutAPoseTheInsertionAloneIsBounded) {
  Watched scope({});
  scope.pose = false;
  scope.step();
  scope.turned = 0.5;
  scope.step();
  EXPECT_EQ(scope.leash.words(), "");
  scope.further = 0.2;
  scope.step();
  EXPECT_NE(scope.leash.words(), "");
}

TEST(Leash, NumbersThatAreNoneAndOldImagesChangeNothing) {
  Leash leash{LeashConfig()};
  LeashObservation image;
  image.time = 1.0;
  image.d2 = 0.1;
  leash.observe(image);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    LeashObservation wrong = image;
    wrong.time = 1.1;
    wrong.to_target[2] = bad;
    leash.observe(wrong);
    wrong = image;
    wrong.time = bad;
    leash.observe(wrong);
    wrong = image;
    wrong.time = 1.1;
    wrong.d2 = bad;
    leash.observe(wrong);
  }
  LeashObservation old = image;
  old.time = 0.9;
  old.to_target[2] = 1.0;
  leash.observe(old);
  EXPECT_EQ(leash.words(), "");
  EXPECT_EQ(leash.used(), 0.0);
}

// A scope that follows no orientation about its shaft turns about itself where it pans, then tilts: that does not
// count, and what is sideways still does.
TEST(Leash, WithoutAnOrientationItBoundsTheDirectionAlone) {
  for (const bool has_orientation : {true, false}) {
    Leash leash{LeashConfig()};
    LeashObservation image;
    image.d2 = 0.1;
    image.has_orientation = has_orientation;
    const auto see = [&](const Eigen::Vector3d& turned) {
      image.time += 0.04;
      Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
      tip.linear() = geometry::so3Exp(turned);
      image.insertion_point_T_tip = tip;
      leash.observe(image);
      return leash.words();
    };
    EXPECT_EQ(see({0.0, 0.0, 0.0}), "");
    EXPECT_EQ(see({0.0, 0.0, 0.3}).empty(), !has_orientation);
    EXPECT_NE(see({0.3, 0.0, 0.0}), "");
  }
}

TEST(Leash, DisabledItBoundsNothing) {
  LeashConfig config;
  config.enabled = false;
  Leash leash(config);
  LeashObservation image;
  for (const double to_go : {0.0, 1.0, 3.0}) {
    image.time += 0.04;
    image.to_target[2] = to_go;
    leash.observe(image);
  }
  EXPECT_EQ(leash.words(), "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
