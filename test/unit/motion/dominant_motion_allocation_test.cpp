// Dominant motion asks for no memory once it is under way, whether it finds a motion or not.
#include <gtest/gtest.h>

#include <vector>

#include "laparoscope_servo/motion/motion_feature_tracker.h"
#include "support/allocation_counter.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::State;

TEST(DominantMotionAllocation, thereIsNone) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  constexpr int kImages = 10;
  const MotionField field = test::usualMotion();
  std::vector<cv::Mat> images;
  for (int k = 0; k < kImages; ++k) {
    images.push_back(test::movingTissue(k, field));
    images.back()(cv::Rect(100 + k, 90, 12, 12)).setTo(cv::Scalar::all(255));
  }
  images[7] = test::movingTissue(0, field, 40);  // has nothing to do with the others
  images[9].setTo(cv::Scalar::all(255));
  MotionFeatureTracker tracker;
  const features::FeaturePrior prior;
  for (int k = 0; k < kImages; ++k) {
    allocations = 0;
    counting = k > 2;
    const State state = tracker.track(images[static_cast<std::size_t>(k)], 0.04 * k, prior).state;
    counting = false;
    EXPECT_EQ(state, k == 0 ? State::kIdle : k < 7 ? State::kTracking : State::kSearching) << "image " << k;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

TEST(DominantMotionAllocation, thereIsNoneWithARegion) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  const MotionField field = test::usualMotion();
  DominantMotion motion;
  for (int k = 0; k < 10; ++k) {
    const cv::Mat image = test::movingTissue(k, field);
    if (k == 0) {
      motion.begin(image, 0.0, geometry::Rectangle{60.0, 70.0, 100.0, 80.0});
      continue;
    }
    allocations = 0;
    counting = k > 2;
    const State state = motion.track(image, 0.04 * k).state;
    counting = false;
    EXPECT_EQ(state, State::kTracking) << "image " << k;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::motion
