// The guard of effect alone: a scope before a plane, moved by hand-made velocities, and what stands between it and the
// picture.
#include "servo/safety/effect_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <random>
#include <utility>

#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo::test {
namespace {

constexpr double kStep = 0.04;   // s, from image to image
constexpr double kDelay = 0.16;  // s

class Scene {
 public:
  explicit Scene(const EffectConfig& config = EffectConfig()) : guard(config, {0.0005, 0.003, 0.003}) {}

  // The scope is told to move, and an image is taken; `seconds`.
  void run(const scope::Velocity& velocity, double seconds) {
    for (double end = time + seconds - 1e-9; time < end; time += kStep) {
      commands.add(time, velocity);
      told_.add(time, velocity);
      const Eigen::Vector4d signed_velocity = signs.cwiseProduct(told_.velocity(time, kDelay));
      loop.move(scope::Velocity::fromVector(signed_velocity), kStep);
      if (report) reports_.push_back({time + kStep, scope::Velocity::fromVector(told_.velocity(time, kDelay))});
      // All that has come since the last step; who asks for the newest alone hears no other.
      for (; !reports_.empty() && reports_.front().first <= time + kStep - report_late; reports_.pop_front()) {
        if (++reported_ % report_every == 0) guard.report(reports_.front().first, reports_.front().second);
      }
      take(image(time + kStep));
      strongest = std::max(strongest, guard.evidence());
    }
  }

  // An image whose stamp is off is later than it says; one that comes out of order is dropped.
  void take(EffectObservation image) {
    image.time += stamps_off * off_(random_);
    if (!(image.time > last_stamp_)) return;
    last_stamp_ = image.time;
    guard.observe(image, commands, kDelay);
  }

  EffectObservation image(double at) {
    EffectObservation image;
    image.time = at;
    if (!frozen) error_ = loop.error();
    image.error = error_;
    const Eigen::Vector2d seen = picture * Eigen::Vector2d(error_.x + tissue(at), error_.y);
    image.error.x = seen.x() + noise_(random_);
    image.error.y = seen.y() + noise_(random_);
    image.error.alpha *= picture.determinant();
    if (goes_on) image.in_last_region = image.error;
    if (goes_on) offset -= image.error.x;
    if (goes_on) region += 1.0;
    goes_on = false;
    image.error.x += offset;
    image.region = region;
    image.scope = loop.scope();
    image.desired_depth = kZ;
    image.corner_error = corner_error;
    image.breath_known = breath_known;
    return image;
  }

  EffectGuard guard;
  PlaneLoop loop{Eigen::Vector3d::UnitZ(), kZ, straight()};
  CommandHistory commands{5.0, 0.2};
  Eigen::Matrix2d picture = Eigen::Matrix2d::Identity();
  Eigen::Vector4d signs = Eigen::Vector4d::Ones();
  std::function<double(double)> tissue = [](double) { return 0.0; };  // normalised, along x
  bool frozen = false;
  double corner_error = 0.1;  // px
  bool report = false;
  double report_late = 0.0;  // s
  double stamps_off = 0.0;   // s, each by another time up to this
  int report_every = 1;      // of its reports so many are one that comes
  bool breath_known = false;
  bool goes_on = false;  // the next image is of another region, in the middle, and tells where the last one is
  double offset = 0.0;   // of the region from the first one, along x
  double region = 0.0;
  double strongest = -100.0;
  double time = 0.0;

 private:
  CommandHistory told_{5.0, 0.2};
  std::deque<std::pair<double, scope::Velocity>> reports_;
  int reported_ = 0;
  double last_stamp_ = -1.0;
  TaskError error_;
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0.0, 0.0003};
  std::uniform_real_distribution<double> off_{0.0, 1.0};
};

const scope::Velocity kRest;
const scope::Velocity kMotion{0.08, -0.05, 0.03, 0.004};

Eigen::Matrix2d rolled(double degrees) {
  return Eigen::Rotation2Dd(degrees * M_PI / 180.0).toRotationMatrix();
}

// The same tissue at another place: what was seen counts on, for a good picture and for one that freezes then.
TEST(EffectGuard, ARegionThatGoesOnKeepsWhatWasSeen) {
  for (const bool freezes : {false, true}) {
    Scene scene;
    scene.run(kRest, 0.5);
    scene.run(kMotion, 1.0);
    ASSERT_TRUE(scene.guard.confirmed());
    const double spent = scene.guard.budget().spent();
    scene.goes_on = true;
    scene.run(kMotion, kStep);
    EXPECT_TRUE(scene.guard.confirmed());
    EXPECT_LE(scene.guard.budget().spent(), spent + 0.1) << "nothing is open again";
    scene.frozen = freezes;
    for (const double sign : {-1.0, 1.0}) scene.run(scope::Velocity::fromVector(sign * kMotion.vector()), 1.0);
    EXPECT_EQ(scene.guard.effect() == Effect::kAsCommanded, !freezes);
  }
}

TEST(EffectGuard, BelievesAPictureThatMovesAsTheScopeDoes) {
  for (const bool report : {false, true}) {
    Scene scene;
    scene.report = report;
    scene.run(kRest, 0.5);
    EXPECT_FALSE(scene.guard.confirmed()) << "nothing has moved yet";
    for (const double sign : {1.0, -1.0, 1.0}) scene.run(scope::Velocity::fromVector(sign * kMotion.vector()), 1.0);
    EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded);
    EXPECT_TRUE(scene.guard.words().empty());
    EXPECT_TRUE(scene.guard.confirmed());
    EXPECT_LT(scene.strongest, 3.0);
  }
}

// A busy machine: reports come late, and of two only the newer is heard.
TEST(EffectGuard, BelievesItThroughReportsThatAreLateOrFew) {
  for (const double late : {0.0, 0.12, 0.24}) {
    for (const int every : {1, 2, 3}) {
      if (late + every * kStep > 0.3) continue;  // nothing is concluded from what is older
      Scene scene;
      scene.report = true;
      scene.report_late = late;
      scene.report_every = every;
      scene.run(kRest, 1.0);
      double speed = 0.0, most_spent = 0.0;
      for (const double sign : {1.0, -1.0, 1.0}) {
        for (int k = 0; k < 25; ++k) {
          speed = std::clamp(speed + 0.5 * sign, -1.0, 1.0);  // by 1 rad/s^2
          const Eigen::Vector4d velocity = speed * kMotion.vector();
          scene.guard.command(kStep * velocity, true);
          scene.run(scope::Velocity::fromVector(velocity), kStep);
          most_spent = std::max(most_spent, scene.guard.budget().spent());
        }
      }
      EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded) << late << " " << every;
      EXPECT_TRUE(scene.guard.confirmed()) << late << " " << every;
      EXPECT_LT(scene.strongest, 3.0) << late << " " << every;
      EXPECT_LT(most_spent, 1.0) << late << " " << every;
    }
  }
}

// A grabber that stamps what it delivers, unevenly.
TEST(EffectGuard, BelievesItThroughStampsThatAreOff) {
  for (const double off : {0.04, 0.1}) {
    for (const bool report : {false, true}) {
      Scene scene;
      scene.report = report;
      scene.stamps_off = off;
      scene.run(kRest, 1.0);
      double speed = 0.0;
      for (const double sign : {1.0, -1.0, 1.0}) {
        for (int k = 0; k < 25; ++k) {
          speed = std::clamp(speed + 0.5 * sign, -1.0, 1.0);
          scene.run(scope::Velocity::fromVector(speed * kMotion.vector()), kStep);
        }
      }
      EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded) << off << " " << scene.guard.words();
      EXPECT_TRUE(scene.guard.confirmed()) << off;
      EXPECT_LT(scene.strongest, 5.0) << off;
    }
  }
}

// Nor do such stamps hide a fault.
TEST(EffectGuard, FindsAMirroredPictureThroughStampsThatAreOff) {
  Scene scene;
  scene.stamps_off = 0.1;
  scene.run(kRest, 1.0);
  scene.picture(0, 0) = -1.0;
  for (int k = 0; k < 25 && scene.guard.effect() == Effect::kAsCommanded; ++k) scene.run(kMotion, kStep);
  EXPECT_EQ(scene.guard.effect(), Effect::kDoubted) << scene.guard.evidence();
}

struct Fault {
  const char* name;
  std::function<void(Scene&)> apply;
  const char* words;
};

void PrintTo(const Fault& fault, std::ostream* stream) {
  *stream << fault.name;
}

class EffectFaults : public ::testing::TestWithParam<Fault> {};

// The scope stands as soon as it is doubted, and what the picture does then makes it certain.
TEST_P(EffectFaults, AreDoubtedSoonAndKnownOnceTheScopeStands) {
  Scene scene;
  scene.run(kRest, 0.5);
  GetParam().apply(scene);
  for (int k = 0; k < 15 && scene.guard.effect() == Effect::kAsCommanded; ++k) scene.run(kMotion, kStep);
  ASSERT_EQ(scene.guard.effect(), Effect::kDoubted) << scene.guard.evidence();
  const std::string words = scene.guard.words();
  EXPECT_EQ(words.rfind("the picture moves as if it were ", 0), 0u) << words;
  scene.run(kRest, 0.36);
  EXPECT_EQ(scene.guard.effect(), Effect::kDoubted) << "the scope has only come to stand";
  EXPECT_EQ(scene.guard.words(), words);
  scene.run(kRest, 0.3);
  EXPECT_EQ(scene.guard.effect(), Effect::kWrong) << scene.guard.evidence();
  EXPECT_NE(scene.guard.words().find(GetParam().words), std::string::npos) << scene.guard.words();
  scene.run(kRest, 20.0);
  EXPECT_EQ(scene.guard.effect(), Effect::kWrong) << "it is not forgotten";
  scene.guard.rearm();
  EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded);
  EXPECT_FALSE(scene.guard.confirmed());
}

INSTANTIATE_TEST_SUITE_P(
    All, EffectFaults,
    ::testing::Values(Fault{"Rolled75", [](Scene& s) { s.picture = rolled(75.0); }, "rolled by"},
                      Fault{"Rolled90", [](Scene& s) { s.picture = rolled(90.0); }, "rolled by"},
                      Fault{"Rolled180", [](Scene& s) { s.picture = rolled(180.0); }, "as if it were"},
                      Fault{"Rolled235", [](Scene& s) { s.picture = rolled(235.0); }, "rolled by"},
                      Fault{"Mirrored", [](Scene& s) { s.picture(0, 0) = -1.0; }, "as if it were"},
                      Fault{"UpsideDown", [](Scene& s) { s.picture(1, 1) = -1.0; }, "as if it were"},
                      Fault{"PanReversed", [](Scene& s) { s.signs[0] = -1.0; }, "as if it were"},
                      Fault{"TiltReversed", [](Scene& s) { s.signs[1] = -1.0; }, "as if it were"},
                      Fault{"Frozen", [](Scene& s) { s.frozen = true; }, "frozen"}),
    [](const ::testing::TestParamInfo<Fault>& fault) { return std::string(fault.param.name); });

TEST(EffectGuard, FindsAPictureThatFreezesInTheMiddleOfAMotion) {
  Scene scene;
  scene.run(kMotion, 1.0);
  ASSERT_EQ(scene.guard.effect(), Effect::kAsCommanded);
  scene.frozen = true;
  scene.run(kMotion, 0.4);
  EXPECT_EQ(scene.guard.effect(), Effect::kDoubted);
  EXPECT_NE(scene.guard.words().find("frozen"), std::string::npos) << scene.guard.words();
}

// What moves before the scope does is the tissue.
TEST(EffectGuard, LeavesMotionToTheTissueThatBeganIt) {
  Scene scene;
  scene.tissue = [](double t) { return 0.1 * std::max(0.0, t - 0.5); };  // away, faster than the scope follows
  scene.run(kRest, 0.8);
  scene.run({0.05, 0.0, 0.0, 0.0}, 1.5);
  EXPECT_LT(scene.strongest, 5.5);
  EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded);
}

TEST(EffectGuard, JudgesNoFrozenPictureWhileAKnownBreathIsFollowed) {
  Scene scene;
  scene.frozen = scene.breath_known = true;
  scene.run(kMotion, 2.0);
  EXPECT_NE(scene.guard.words().find("frozen"), 0u);
  EXPECT_EQ(scene.guard.words().find("frozen"), std::string::npos);
}

// Images apart, another region, an image twice: nothing to compare, and nothing to conclude.
TEST(EffectGuard, ComparesNothingOverAGap) {
  Scene scene;
  scene.run(kRest, 0.2);
  EffectObservation late = scene.image(scene.time + 0.6);
  late.error.x += 0.3;
  const double before = scene.guard.evidence();
  scene.guard.observe(late, scene.commands, kDelay);
  EXPECT_EQ(scene.guard.evidence(), before);
  late.error.x += 0.3;  // the same time
  scene.guard.observe(late, scene.commands, kDelay);
  EXPECT_EQ(scene.guard.evidence(), before);
  EffectObservation other = scene.image(late.time + kStep);
  other.error.m_star.x() = 0.1;
  other.error.x -= 0.3;
  scene.guard.observe(other, scene.commands, kDelay);
  EXPECT_EQ(scene.guard.evidence(), before);
}

TEST(EffectGuard, IsNotHurtByNumbersThatAreNone) {
  Scene scene;
  scene.run(kMotion, 0.6);
  const double before = scene.guard.evidence();
  EffectObservation bad = scene.image(scene.time + kStep);
  bad.error.x = std::nan("");
  scene.guard.observe(bad, scene.commands, kDelay);
  scene.guard.report(std::nan(""), kMotion);
  scene.guard.report(scene.time, {std::nan(""), 0.0, 0.0, 0.0});
  EXPECT_EQ(scene.guard.evidence(), before);
  scene.run(kMotion, 0.6);
  EXPECT_TRUE(std::isfinite(scene.guard.evidence()));
  EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded);
}

TEST(EffectGuard, SaysNothingWhenItIsOff) {
  EffectConfig config;
  config.enabled = false;
  Scene scene(config);
  scene.picture = rolled(180.0);
  scene.run(kMotion, 2.0);
  EXPECT_EQ(scene.guard.effect(), Effect::kAsCommanded);
}

// Where the scope is said to be nowhere, no explanation says where the picture should be: from the next image on the
// guard sees again.
TEST(EffectGuard, SeesAgainAfterAGeometryThatIsNone) {
  for (const double d2 : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Scene scene;
    scene.run(kMotion, 0.6);
    EffectObservation bad = scene.image(scene.time + kStep);
    bad.scope.d2 = d2;
    scene.guard.observe(bad, scene.commands, kDelay);
    scene.time += kStep;
    scene.picture = rolled(180.0);
    scene.run(kMotion, 3.0);
    EXPECT_TRUE(std::isfinite(scene.guard.evidence())) << d2;
    EXPECT_EQ(scene.guard.effect(), Effect::kWrong) << d2;
  }
}

// As one that is worse than any that the tracker believes in.
TEST(EffectGuard, ACornerErrorThatIsNoNumberIsABadOne) {
  double evidence[3];
  const double errors[] = {0.1, std::nan(""), 100.0};
  for (int k = 0; k < 3; ++k) {
    Scene scene;
    scene.corner_error = errors[k];
    scene.run(kMotion, 1.0);
    evidence[k] = scene.guard.evidence();
  }
  EXPECT_NE(evidence[0], evidence[2]);
  EXPECT_EQ(evidence[1], evidence[2]);
}

}  // namespace
}  // namespace laparoscope_servo::servo::test
