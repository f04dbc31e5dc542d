// A tracker, and a camera that moves over tissue.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {

inline const geometry::Rectangle kRoi = {110, 80, 112, 112};
inline const cv::Size kSize(360, 300);

inline Eigen::Matrix3d motion(int frame) {
  const double t = frame / 20.0;
  Eigen::Matrix3d g;
  const double angle = 0.1 * std::sin(t);
  g << std::cos(angle), -std::sin(angle), 20.0 * std::sin(1.3 * t) + 25.0 * angle, std::sin(angle), std::cos(angle),
      12.0 * std::sin(t) - 20.0 * angle, 0.0, 1e-4 * std::sin(t), 1.0;
  return g;
}

class RegionTrackerTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(kSize, 31);
  RegionTracker tracker_{TrackerConfig()};

  cv::Mat image(int frame, double gain = 1.0) const {
    return test::view(scene_, motion(frame), gain, 0.0, 2.0, 1000 + frame);
  }
  void select() {
    const TrackResult result = tracker_.select(test::view(scene_, motion(0), 1.0, 0.0, 2.0), 0.0, kRoi);
    ASSERT_EQ(result.state, State::kTracking);
    ASSERT_TRUE(result.selected_now);
  }
  static double error(const TrackResult& r, int frame) { return geometry::cornerDistance(r.g, motion(frame), kRoi); }
};

}  // namespace laparoscope_servo::tracking
