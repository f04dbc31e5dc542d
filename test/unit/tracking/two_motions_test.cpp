// A region with two things in it that part: the tracker does not say TRACKING with the tissue elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(420, 340);
constexpr double kPeriod = 0.04;  // s
constexpr double kWrong = 5.0;    // px

Eigen::Matrix3d shifted(const Eigen::Vector2d& by) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() = by;
  return g;
}

// Two layers; the upper one is seen where its mask is not 0.
struct Layers {
  cv::Mat below, above;
  cv::Mat1b mask;

  // The upper layer has moved by so many px.
  cv::Mat image(const Eigen::Vector2d& of_above, unsigned seed) const {
    cv::Mat result = test::view(below, shifted({0.0, 0.0}), 1.0, 0.0, 1.5, seed);
    cv::Mat moved_mask;
    cv::warpPerspective(mask, moved_mask, test::toMatx(shifted(of_above)), mask.size(), cv::INTER_NEAREST);
    test::view(above, shifted(of_above), 1.0, 0.0, 1.5, seed + 1000).copyTo(result, moved_mask);
    return result;
  }

  // Median over what of the region shows the lower layer, which stands still, of how far g is off [px].
  double off(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const {
    std::vector<double> all;
    for (double y = roi.y; y < roi.y + roi.height; y += 4.0) {
      for (double x = roi.x; x < roi.x + roi.width; x += 4.0) {
        const Eigen::Vector2d p(x, y);
        if (mask(static_cast<int>(y), static_cast<int>(x)) == 0) all.push_back((geometry::apply(g, p) - p).norm());
      }
    }
    return robust::median(all);
  }
};

struct Outcome {
  int tracking = 0;    // images
  double worst = 0.0;  // px, of those, see Layers::off
};

constexpr int kImages = 40;  // in the last of which the upper layer has moved by `apart` px

Outcome run(const Layers& layers, const geometry::Rectangle& roi, const Eigen::Vector2d& apart) {
  RegionTracker tracker{TrackerConfig()};
  tracker.select(layers.image({0, 0}, 1), 0.0, roi);
  Outcome outcome;
  for (int k = 1; k <= kImages; ++k) {
    const double share = static_cast<double>(k) / kImages;
    const TrackResult& r = tracker.track(layers.image(share * apart, 1 + k), kPeriod * k);
    if (r.state != State::kTracking) continue;
    ++outcome.tracking;
    outcome.worst = std::max(outcome.worst, layers.off(r.g, roi));
  }
  return outcome;
}

// The lower part of the region is a shaft, which hardly has texture; the tissue above it is smooth but for one spot.
// The tissue is tracked on.
TEST(TwoMotions, AnInstrumentThatLayInTheRegionMovesOn) {
  const geometry::Rectangle roi = {150, 60, 100, 200};
  for (unsigned seed = 1; seed <= 2; ++seed) {
    Layers layers;
    const cv::Mat texture = test::tissue(kSize, 40 + seed);
    cv::GaussianBlur(texture, layers.below, cv::Size(), 20.0);
    const cv::Rect spot(160, 75, 80, 60);
    texture(spot).copyTo(layers.below(spot));
    layers.mask = cv::Mat1b::zeros(kSize);
    layers.mask(cv::Rect(0, 180, kSize.width, 120)).setTo(255);
    layers.above = cv::Mat(kSize, CV_8UC3);
    for (int y = 0; y < kSize.height; ++y) {
      const double shade = 150.0 + 60.0 * std::sin(M_PI * (y - 180.0) / 120.0);
      layers.above.row(y).setTo(cv::Scalar(shade, 0.97 * shade, 0.93 * shade));
    }
    cv::addWeighted(layers.above, 1.0, test::tissue(kSize, 80 + seed), 0.12, -10.0, layers.above);
    for (const Eigen::Vector2d& apart : {Eigen::Vector2d(0.0, 24.0), Eigen::Vector2d(20.0, 0.0)}) {
      const Outcome outcome = run(layers, roi, apart);
      EXPECT_LT(outcome.worst, kWrong) << seed << ": " << apart.transpose();
      EXPECT_GT(outcome.tracking, 30) << seed << ": " << apart.transpose();
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
