// Tracking instruments does not allocate once it is under way.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "laparoscope_servo/model/instrument_feature_tracker.h"
#include "support/allocation_counter.h"
#include "support/synthetic_instrument.h"

namespace laparoscope_servo::model {
namespace {

using features::State;

test_support::ShaftScene at(int k) {
  test_support::ShaftScene scene;
  const double angle = 3.3 + 0.02 * k;
  const cv::Point2d trocar(900.0, 350.0), direction(std::cos(angle), std::sin(angle));
  scene.entry = trocar + 200.0 * direction;
  scene.tip = trocar + (620.0 + 3.0 * k) * direction;
  scene.seed = k + 1;
  return scene;
}

TEST(InstrumentsAllocation, thereIsNoneWhileTracking) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  constexpr int kImages = 12, kKnown = 4;
  std::vector<cv::Mat> images;
  for (int k = 0; k < kImages; ++k) images.push_back(test_support::drawShaft(at(k)).image);
  InstrumentConfig config;
  config.radius = 0.0025;
  InstrumentFeatureTracker tracker(config);
  features::FeaturePrior prior;
  prior.camera = geometry::PinholeCamera{600.0, 600.0, 320.0, 240.0};
  for (int k = 0; k < kImages; ++k) {
    allocations = 0;
    counting = k >= kKnown;
    const features::TrackedFeatures& result = tracker.track(images[static_cast<std::size_t>(k)], 0.04 * k, prior);
    counting = false;
    EXPECT_EQ(result.features.size(), 4u) << "image " << k;  // two edges, the tip, the pose
    EXPECT_EQ(result.state, State::kTracking) << "image " << k;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::model
