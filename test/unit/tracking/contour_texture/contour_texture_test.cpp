#include "laparoscope_servo/tracking/contour_texture.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "support/contour_scene.h"
#include "support/error_text.h"

namespace laparoscope_servo::tracking {
namespace {

using features::State;
using test_support::ContourScene;

constexpr double kPeriod = 0.04;  // s

ContourScene::Look smooth() {
  return {};
}
ContourScene::Look textured() {
  ContourScene::Look look;
  look.texture = 12.0;
  look.background = 8.0;
  return look;
}

ContourTextureConfig only(bool texture, bool contour) {
  ContourTextureConfig config;
  config.texture = texture;
  config.contour = contour;
  return config;
}

struct Outcome {
  int kept = 0;        // images TRACKING, less than 2 px off
  int wrong = 0;       // images TRACKING, more than that off
  double worst = 0.0;  // px, while TRACKING
};

class ContourTextureTest : public testing::Test {
 protected:
  static constexpr int kImages = 60;

  static Outcome run(const ContourScene& scene, const ContourTextureConfig& config,
                     const std::function<ContourScene::Cover(int)>& cover = nullptr) {
    ContourTextureTracker tracker(config);
    tracker.select(scene.image(0, 1), 0.0, ContourScene::selection(), {});
    Outcome outcome;
    for (int k = 1; k < kImages; ++k) {
      const cv::Mat image = scene.image(k, static_cast<unsigned>(k + 1), cover ? cover(k) : nullptr);
      const features::TrackedFeature& told = tracker.track(image, k * kPeriod, {}).features.at(0);
      if (told.state != State::kTracking) continue;
      const double error = scene.error(told.parameters, k);
      ++(error < 2.0 ? outcome.kept : outcome.wrong);
      outcome.worst = std::max(outcome.worst, error);
    }
    return outcome;
  }
};

TEST_F(ContourTextureTest, FollowsAThingThatHasBoth) {
  const Outcome both = run(ContourScene(textured()), only(true, true));
  EXPECT_EQ(both.kept, kImages - 1);
  EXPECT_LT(both.worst, 0.5);
}

// A smooth surface: grey levels tell nothing, the outline does.
TEST_F(ContourTextureTest, KeepsASmoothThingThatTextureAloneLoses) {
  const ContourScene scene(smooth());
  EXPECT_EQ(run(scene, only(true, true)).kept, kImages - 1);
  EXPECT_LT(run(scene, only(true, false)).kept, kImages / 2);
}

// What covers the outline all around, from image 10 to 40, and has an edge of its own beside it.
TEST_F(ContourTextureTest, KeepsAThingWithACoveredOutlineThatTheContourAloneLoses) {
  const ContourScene scene(textured());
  const auto cover = [&](int k) -> ContourScene::Cover {
    if (k < 10 || k > 40) return nullptr;
    return [&scene, k](cv::Mat1f& picture) {
      const Eigen::Vector2d centre = scene.place(ContourScene::kCentre, k);
      cv::Mat1b ring = cv::Mat1b::zeros(picture.size());
      cv::circle(ring, {static_cast<int>(centre.x()) + 6, static_cast<int>(centre.y())}, 95, 255, cv::FILLED);
      cv::circle(ring, {static_cast<int>(centre.x()) + 6, static_cast<int>(centre.y())}, 54, 0, cv::FILLED);
      picture.setTo(60.0f, ring);
    };
  };
  const Outcome both = run(scene, only(true, true), cover), contour = run(scene, only(false, true), cover);
  EXPECT_EQ(both.kept, kImages - 1);
  EXPECT_LT(contour.kept, kImages - 10);
}

TEST_F(ContourTextureTest, SaysThatItIsGoneAndFindsItAgainWhereItWas) {
  const ContourScene scene(textured());
  ContourTextureTracker tracker;
  tracker.select(scene.image(0, 1), 0.0, ContourScene::selection(), {});
  const cv::Mat empty(ContourScene::kSize, CV_8UC1, cv::Scalar(90));
  for (int k = 1; k < 10; ++k) {
    cv::Mat noise(empty.size(), CV_8UC1);
    cv::RNG(static_cast<unsigned>(k)).fill(noise, cv::RNG::UNIFORM, 0, 4);
    const features::TrackedFeatures& told = tracker.track(empty + noise, k * kPeriod, {});
    EXPECT_EQ(told.state, State::kSearching) << k;
    EXPECT_FALSE(told.reason.empty());
    EXPECT_TRUE(std::isinf(told.features.at(0).expected_error));
  }
  State state = State::kSearching;
  for (int k = 10; k < 16; ++k) {
    state = tracker.track(scene.image(0, static_cast<unsigned>(k)), k * kPeriod, {}).state;
  }
  EXPECT_EQ(state, State::kTracking);
}

TEST_F(ContourTextureTest, ErrorsAreAsLargeAsClaimed) {
  const ContourScene scene(textured());
  ContourTextureTracker tracker;
  tracker.select(scene.image(0, 1), 0.0, ContourScene::selection(), {});
  double squares = 0.0, claimed = 0.0;
  for (int k = 1; k < kImages; ++k) {
    const features::TrackedFeature& told =
        tracker.track(scene.image(k, static_cast<unsigned>(k + 1)), k * kPeriod, {}).features.at(0);
    squares += std::pow(scene.error(told.parameters, k), 2);
    claimed += std::pow(told.expected_error, 2);
    ASSERT_EQ(told.covariance.rows(), 8);
    EXPECT_TRUE(told.covariance.allFinite());
    EXPECT_GT(told.covariance.diagonal().minCoeff(), 0.0);
  }
  EXPECT_LT(squares, 4.0 * claimed);
  EXPECT_GT(squares, 0.01 * claimed);
}

TEST_F(ContourTextureTest, TheSameImagesGiveTheSameNumbers) {
  const ContourScene scene(textured());
  ContourTextureTracker a, b;
  for (ContourTextureTracker* tracker : {&a, &b})
    tracker->select(scene.image(0, 1), 0.0, ContourScene::selection(), {});
  for (int k = 1; k < 10; ++k) {
    const cv::Mat image = scene.image(k, static_cast<unsigned>(k));
    EXPECT_EQ(a.track(image, k * kPeriod, {}).features.at(0).parameters,
              b.track(image, k * kPeriod, {}).features.at(0).parameters);
  }
}

TEST_F(ContourTextureTest, RefusesWhatItCannotFollowAndGoesOn) {
  const ContourScene scene(textured());
  const cv::Mat image = scene.image(0, 1);
  ContourTextureTracker tracker;
  tracker.select(image, 0.0, ContourScene::selection(), {});
  const auto refusal = [&](const features::FeatureSelection& selection) -> std::string {
    return test_support::errorText<std::invalid_argument>([&] { tracker.select(image, 0.0, selection, {}); });
  };
  features::FeatureSelection open = ContourScene::selection();
  open[0].closed = false;
  EXPECT_NE(refusal(open).find("thing: closed = false, expected true"), std::string::npos) << refusal(open);
  features::FeatureSelection two = ContourScene::selection();
  two.push_back(two[0]);
  two[1].id = "other";
  EXPECT_NE(refusal(two).find("2 features, expected 1"), std::string::npos) << refusal(two);
  EXPECT_NE(refusal({}).find("0 features, expected 1"), std::string::npos);
  features::FeatureSelection away = ContourScene::selection();
  for (Eigen::Vector2d& point : away[0].points) point.x() += 60.0;
  EXPECT_NE(refusal(away).find("thing: no such edge in the image"), std::string::npos) << refusal(away);
  EXPECT_EQ(tracker.track(scene.image(1, 2), kPeriod, {}).state, State::kTracking);
  EXPECT_THROW(tracker.track(cv::Mat(), 2.0 * kPeriod, {}), std::invalid_argument);
  EXPECT_THROW(tracker.track(cv::Mat1f::zeros(240, 320), 2.0 * kPeriod, {}), std::invalid_argument);
  EXPECT_EQ(tracker.track(scene.image(2, 3), 2.0 * kPeriod, {}).state, State::kTracking);
}

TEST_F(ContourTextureTest, AnotherSizeAndATimeThatJumpsBackEndIt) {
  const ContourScene scene(textured());
  const cv::Mat image = scene.image(0, 1);
  ContourTextureTracker tracker;
  EXPECT_EQ(tracker.track(image, 0.0, {}).state, State::kIdle);
  tracker.select(image, 1.0, ContourScene::selection(), {});
  EXPECT_EQ(tracker.track(image, 0.5, {}).state, State::kIdle);
  EXPECT_NE(tracker.features().reason.find("stamp lies before"), std::string::npos) << tracker.features().reason;
  tracker.select(image, 1.0, ContourScene::selection(), {});
  EXPECT_EQ(tracker.track(image(cv::Rect(0, 0, 300, 200)), 1.04, {}).state, State::kIdle);
  tracker.select(image, 1.0, ContourScene::selection(), {});
  tracker.reset();
  EXPECT_EQ(tracker.features().state, State::kIdle);
  EXPECT_TRUE(tracker.features().features.empty());
}

TEST(ContourTextureConfig, NamesEveryError) {
  ContourTextureConfig config = only(false, false);
  config.min_correlation = 2.0;
  config.edges.range = 1.0;
  const std::vector<std::string> errors = validate(config);
  EXPECT_EQ(errors.size(), 3u);
  EXPECT_THROW(ContourTextureTracker{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
