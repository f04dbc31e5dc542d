#include "laparoscope_servo/features/dots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using Cover = std::function<void(cv::Mat1f&)>;

Points squareAt(int image) {
  const Eigen::Vector2d middle(160.0 + 12.3 * std::sin(image / 5.0), 120.0 + 9.1 * std::cos(image / 7.0));
  const double turn = 0.3 + 0.1 * std::sin(image / 6.0);
  Points result;
  for (int k = 0; k < 4; ++k) {
    result.push_back(middle + 45.0 * Eigen::Vector2d(std::cos(turn + k * M_PI / 2), std::sin(turn + k * M_PI / 2)));
  }
  return result;
}

cv::Mat draw(const Points& points, int image, const Cover& cover = nullptr, double radius = 8.0,
             test::EdgeScene scene = {}) {
  scene.seed = static_cast<unsigned>(image + 1);
  return test::draw(
      scene,
      [&](const Eigen::Vector2d& p) {
        for (const Eigen::Vector2d& point : points) {
          if ((p - point).squaredNorm() < radius * radius) return true;
        }
        return false;
      },
      cover);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

TEST(Dots, followsDotsToAFractionOfAPixel) {
  for (const bool dark : {false, true}) {
    test::EdgeScene scene;
    if (dark) std::swap(scene.dark, scene.bright);
    DotTracker tracker;
    std::vector<double> errors;
    for (int k = 0; k < 25; ++k) {
      const Points truth = squareAt(k);
      const cv::Mat image = draw(truth, k, nullptr, 8.0, scene);
      if (k == 0) {
        Points clicks = truth;
        for (Eigen::Vector2d& click : clicks) click += Eigen::Vector2d(3.0, -2.0);
        EXPECT_TRUE(tracker.select(image, 0.0, clicks).selected_now);
        continue;
      }
      const DotsResult& result = tracker.track(image, 0.04 * k);
      ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
      for (std::size_t i = 0; i < 4; ++i) {
        const double error = (result.dots[i].centre - truth[i]).norm();
        EXPECT_LT(error, 5.0 * result.dots[i].expected_error);
        EXPECT_NEAR(result.dots[i].area, M_PI * 64.0, 8.0);
        errors.push_back(error);
      }
    }
    EXPECT_LT(median(errors), 0.03) << dark;
  }
}

// One of them is covered, and goes on behind the cover: it is not claimed, nobody takes its place, and it comes back.
TEST(Dots, keepsThemApartWhenOneIsCovered) {
  DotTracker tracker;
  for (int k = 0; k < 40; ++k) {
    const Points truth = squareAt(k);
    const bool covered = k > 4 && k < 25;
    const cv::Mat image = draw(truth, k, [&](cv::Mat1f& pixels) {
      if (covered) cv::circle(pixels, cv::Point2d(truth[1].x(), truth[1].y()), 14, cv::Scalar(60.0), cv::FILLED);
    });
    if (k == 0) {
      tracker.select(image, 0.0, truth);
      continue;
    }
    const DotsResult& result = tracker.track(image, 0.04 * k);
    for (std::size_t i = 0; i < 4; ++i) {
      const DotResult& dot = result.dots[i];
      const bool claimed = dot.state == State::kTracking;
      if (i == 1 && covered) {
        EXPECT_FALSE(claimed) << "image " << k;
      }
      if (i != 1 || k < 5 || k > 30) {
        EXPECT_TRUE(claimed) << "image " << k << ", dot " << i;
      }
      EXPECT_LT((dot.centre - truth[i]).norm(), claimed ? 0.2 : 4.0) << "image " << k << ", dot " << i;
    }
    EXPECT_EQ(result.state == State::kTracking, result.dots[1].state == State::kTracking);
  }
}

// A cover that slides over a dot bit by bit: what is claimed is where it is.
TEST(Dots, claimsNoCentreThatACoverHasShifted) {
  DotTracker tracker;
  const Points truth{{160.0, 120.0}};
  int claims = 0;
  for (int k = 0; k < 40; ++k) {
    const cv::Mat image = draw(truth, k, [&](cv::Mat1f& pixels) {
      const int width = static_cast<int>(145 + 0.7 * k);  // reaches the dot at 152 in the tenth image
      pixels(cv::Rect(0, 0, width, pixels.rows)).setTo(70.0f);
    });
    if (k == 0) {
      tracker.select(image, 0.0, truth);
      continue;
    }
    const DotsResult& result = tracker.track(image, 0.04 * k);
    if (result.state != State::kTracking) continue;
    ++claims;
    EXPECT_LT((result.dots[0].centre - truth[0]).norm(), std::max(0.25, 3.0 * result.dots[0].expected_error))
        << "image " << k;
  }
  EXPECT_GE(claims, 8);
  EXPECT_LT(claims, 25);
}

// A highlight next to a dot, then one that merges with it.
TEST(Dots, aHighlightIsNoDot) {
  DotTracker tracker;
  for (int k = 0; k < 20; ++k) {
    const Points truth = squareAt(0);
    const cv::Mat image = draw(truth, k, [&](cv::Mat1f& pixels) {
      if (k == 0) return;
      const double away = k < 10 ? 22.0 : 7.0;
      cv::ellipse(pixels, cv::Point2d(truth[0].x() + away, truth[0].y()), cv::Size(6, 4), 20.0, 0.0, 360.0,
                  cv::Scalar(255.0), cv::FILLED);
    });
    if (k == 0) {
      tracker.select(image, 0.0, truth);
      continue;
    }
    const DotResult& dot = tracker.track(image, 0.04 * k).dots[0];
    EXPECT_EQ(dot.state == State::kTracking, k < 10) << "image " << k;
    if (k < 10) {
      EXPECT_LT((dot.centre - truth[0]).norm(), 0.2) << "image " << k;
    }
  }
}

TEST(Dots, aDotThatVanishesIsNotClaimedThoughAnotherIsNear) {
  DotTracker tracker;
  const Points two{{150.0, 120.0}, {175.0, 120.0}};
  tracker.select(draw(two, 0), 0.0, two);
  const Points one{two[1]};
  for (int k = 1; k < 12; ++k) {
    const DotsResult& result = tracker.track(draw(one, k), 0.04 * k);
    EXPECT_EQ(result.dots[0].state, State::kSearching) << "image " << k;
    EXPECT_TRUE(std::isinf(result.dots[0].expected_error));
    EXPECT_TRUE(std::isinf(result.dots[0].covariance(0, 0)) && std::isinf(result.dots[0].covariance(1, 1)));
    EXPECT_EQ(result.dots[0].covariance(0, 1), 0.0);
    EXPECT_EQ(result.dots[0].covariance(1, 0), 0.0);
    EXPECT_EQ(result.dots[1].state, State::kTracking) << "image " << k;
    EXPECT_LT((result.dots[1].centre - two[1]).norm(), 0.2);
  }
}

TEST(Dots, bearsLightAndColour) {
  DotTracker tracker;
  for (int k = 0; k < 16; ++k) {
    const Points truth = squareAt(k);
    cv::Mat image = draw(truth, k), colour;
    image.convertTo(image, -1, k < 8 ? 1.0 : 0.75, k < 8 ? 0.0 : 12.0);
    cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
    if (k == 0) {
      tracker.select(colour, 0.0, truth);
      continue;
    }
    const DotsResult& result = tracker.track(colour, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    EXPECT_LT((result.dots[2].centre - truth[2]).norm(), 0.2);
  }
}

TEST(Dots, aMotionThatIsKnownLeadsFurtherThanTheRange) {
  DotTracker tracker;
  const Points before{{100.0, 100.0}, {130.0, 100.0}};
  Points after = before;
  for (Eigen::Vector2d& point : after) point += Eigen::Vector2d(60.0, 30.0);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
  motion.topRightCorner<2, 1>() << 60.0, 30.0;
  tracker.select(draw(before, 0), 0.0, before);
  const DotsResult& result = tracker.track(draw(after, 1), 0.04, motion);
  ASSERT_EQ(result.state, State::kTracking);
  EXPECT_LT((result.dots[0].centre - after[0]).norm(), 0.2);
  EXPECT_LT((result.dots[1].centre - after[1]).norm(), 0.2);
}

TEST(Dots, refusesSelectionsByNameAndGoesOn) {
  const Points truth = squareAt(0);
  const cv::Mat image = draw(truth, 0);
  DotTracker tracker;
  EXPECT_EQ(tracker.track(image, 0.0).state, State::kIdle);
  tracker.select(image, 0.0, truth);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Points& bad : {Points{}, Points{{nan, 10.0}}, Points{{-30.0, 20.0}}, Points{{1e12, 20.0}},
                            Points{{160.0, 120.0}}, Points{truth[0], truth[0] + Eigen::Vector2d(2.0, 1.0)}}) {
    EXPECT_THROW(tracker.select(image, 0.0, bad), std::invalid_argument);
  }
  EXPECT_THROW(tracker.select(cv::Mat(), 0.0, truth), std::invalid_argument);
  try {
    tracker.select(image, 0.0, {{160.0, 120.5}});
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("(160, 120.5), expected"), std::string::npos) << error.what();
  }
  EXPECT_EQ(tracker.track(draw(truth, 1), 0.04).state, State::kTracking);
  DotsConfig config;
  config.min_radius = 80.0;
  config.max_error = nan;
  EXPECT_EQ(validate(config).size(), 2u);
  EXPECT_THROW(DotTracker{config}, std::invalid_argument);
}

TEST(Dots, resetsWhenTimeJumpsBackOrTheImageChanges) {
  const Points truth = squareAt(0);
  const cv::Mat image = draw(truth, 0);
  DotTracker tracker;
  tracker.select(image, 10.0, truth);
  EXPECT_EQ(tracker.track(image, 9.0).reason, Reason::kTimeJumpedBack);
  EXPECT_TRUE(tracker.track(image, 11.0).dots.empty());
  tracker.select(image, 10.0, truth);
  EXPECT_EQ(tracker.track(image(cv::Rect(0, 0, 300, 200)), 10.1).reason, Reason::kImageChanged);
  tracker.select(image, 10.0, truth);
  tracker.reset();
  EXPECT_EQ(tracker.track(image, 10.1).reason, Reason::kReset);
}

}  // namespace
}  // namespace laparoscope_servo::features
