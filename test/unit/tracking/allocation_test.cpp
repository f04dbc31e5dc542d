// Tracking asks for no memory once it is under way.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/allocation_counter.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

constexpr int kWarmUp = 5;
constexpr int kImages = 40;
const geometry::Rectangle kRoi = {110, 80, 112, 112};
const cv::Size kSize(360, 300);

// Turns, shifts and comes closer, so that no two crops of the image have one size.
Eigen::Matrix3d motion(int image) {
  const double t = image / 12.0;
  const double angle = 0.1 * std::sin(t);
  const double scale = 1.0 + 0.4 * image / kImages;
  const Eigen::Vector2d centre = kRoi.centre();
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topLeftCorner<2, 2>() = scale * Eigen::Rotation2Dd(angle).toRotationMatrix();
  g.topRightCorner<2, 1>() =
      centre - g.topLeftCorner<2, 2>() * centre + Eigen::Vector2d(20.0 * std::sin(t), 8.0 * std::sin(2.0 * t));
  return g;
}

cv::Mat seen(const cv::Mat& scene, int image) {
  const double gain = 1.0 + 0.2 * std::sin(image / 5.0);
  cv::Mat result = test::view(scene, motion(image), gain, 4.0 * std::cos(image / 3.0), 2.0, 100 + image);
  result(cv::Rect(60 + 5 * image, 60, 30, 200)).setTo(cv::Scalar(190, 190, 190));  // an instrument that crosses
  result(cv::Rect(180, 120 + image, 12, 5)).setTo(cv::Scalar::all(255));           // a highlight
  return result;
}

struct Variant {
  const char* name;
  TrackedChannels channels;
  bool colour;
};

class AllocationTest : public ::testing::TestWithParam<Variant> {};

TEST_P(AllocationTest, ThereIsNoneWhileTracking) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  TrackerConfig config;
  config.esm.channels = GetParam().channels;
  config.search.keyframes = 0;  // a new view is stored now and then, not image by image
  cv::Mat scene = cv::min(test::tissue(kSize, 31), 235);
  if (!GetParam().colour) cv::cvtColor(scene, scene, cv::COLOR_BGR2GRAY);
  std::vector<cv::Mat> images;
  for (int k = 0; k <= kImages; ++k) images.push_back(seen(scene, k));

  RegionTracker tracker(config);
  tracker.select(test::view(scene, Eigen::Matrix3d::Identity()), 0.0, kRoi);
  for (int k = 1; k <= kImages; ++k) {
    allocations = 0;
    counting = k > kWarmUp;
    const TrackResult& result = tracker.track(images[k], 0.04 * k);
    counting = false;
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << result.reason;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

// What the test above counts with does count.
TEST(AllocationCounterTest, SeesNewAndOpenCv) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  allocations = 0;
  counting = true;
  std::vector<double> numbers(100);
  const int by_vector = allocations;
  const cv::Mat pixels(10, 10, CV_8UC1);
  counting = false;
  EXPECT_EQ(numbers.size(), pixels.total());
  EXPECT_EQ(by_vector, 1);
  EXPECT_GT(allocations, by_vector);
}

INSTANTIATE_TEST_SUITE_P(Variants, AllocationTest,
                         ::testing::Values(Variant{"strongest", TrackedChannels::kStrongest, true},
                                           Variant{"colour", TrackedChannels::kColour, true},
                                           Variant{"grey", TrackedChannels::kStrongest, false}),
                         [](const auto& variant) { return std::string(variant.param.name); });

}  // namespace
}  // namespace laparoscope_servo::tracking
