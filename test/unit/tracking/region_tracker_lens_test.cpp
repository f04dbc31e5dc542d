// The tracker on raw images of a distorting lens.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_lens.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(480, 360);
const geometry::Rectangle kRoi = {60, 40, 120, 110};  // in the upper left, where the lens bends most

// Across the image, with a turn, a tilt and a change of scale.
Eigen::Matrix3d motion(int frame) {
  const double t = frame / 12.0;
  Eigen::Matrix3d g;
  const double angle = 0.15 * std::sin(t);
  const double scale = 1.0 + 0.08 * std::sin(0.7 * t);
  g << scale * std::cos(angle), -std::sin(angle), 130.0 * std::sin(0.5 * t) + 10.0 * angle, std::sin(angle),
      scale * std::cos(angle), 90.0 * std::sin(0.4 * t), 0.0, 2e-4 * std::sin(t), 1.0;
  return g / std::cbrt(g.determinant());
}

image::LensParameters lensOf(image::Distortion model) {
  if (model == image::Distortion::kPlumbBob) return test::laparoscope(kSize, 330.0);
  if (model == image::Distortion::kRationalPolynomial) return test::rational(kSize, 330.0);
  return test::equidistant(kSize, 250.0);
}

class RegionTrackerLens : public ::testing::TestWithParam<image::Distortion> {
 protected:
  RegionTrackerLens() : lens_(lensOf(GetParam())), view_(lens_, kSize) {}

  cv::Mat image(int frame) const { return noisy(view_(scene_, motion(frame)), frame); }

  static cv::Mat noisy(const cv::Mat& clean, unsigned seed) {
    cv::Mat exact, result;
    clean.convertTo(exact, CV_32FC3);
    cv::Mat grain(exact.size(), exact.type());
    cv::RNG rng(seed + 1);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, 2.0);
    exact += grain;
    exact.convertTo(result, CV_8UC3);
    return result;
  }

  RegionTracker tracker() const {
    RegionTracker result{TrackerConfig()};
    result.setLens(lens_);
    return result;
  }

  static double error(const TrackResult& r, int frame) { return geometry::cornerDistance(r.g, motion(frame), kRoi); }

  const image::Lens lens_;
  const test::LensView view_;
  const cv::Mat scene_ = test::tissue(cv::Size(640, 480), 3);
};

TEST_P(RegionTrackerLens, FollowsAcrossTheImageInRectifiedPixels) {
  RegionTracker with = tracker();
  ASSERT_EQ(with.select(image(0), 0.0, kRoi).state, State::kTracking);
  double worst = 0.0;
  for (int frame = 1; frame <= 36; ++frame) {
    const TrackResult r = with.track(image(frame), 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    worst = std::max(worst, error(r, frame));
  }
  EXPECT_LT(worst, 0.2);
  RecordProperty("worst_corner_px", std::to_string(worst));
}

TEST_P(RegionTrackerLens, IsNeededForThat) {
  // Without the lens the corners are raw pixels; where they are seen is known. The ROI is that of the raw image.
  RegionTracker without{TrackerConfig()};
  const cv::Rect seen = image::rawBox(lens_, kRoi.corners(), 0.0);
  const geometry::Rectangle roi{static_cast<double>(seen.x), static_cast<double>(seen.y),
                                static_cast<double>(seen.width), static_cast<double>(seen.height)};
  ASSERT_EQ(without.select(image(0), 0.0, roi).state, State::kTracking);
  double worst = 0.0;
  for (int frame = 1; frame <= 36; ++frame) {
    const TrackResult r = without.track(image(frame), 0.04 * frame);
    if (r.state != State::kTracking) break;
    for (const Eigen::Vector2d& corner : roi.corners()) {
      const auto before = lens_.toRectified(corner);
      const auto now = before ? lens_.toRaw(geometry::apply(motion(frame), *before)) : std::nullopt;
      ASSERT_TRUE(now);
      worst = std::max(worst, (geometry::apply(r.g, corner) - *now).norm());
    }
  }
  EXPECT_GT(worst, 1.0);
  RecordProperty("worst_corner_px", std::to_string(worst));
}

TEST_P(RegionTrackerLens, TracksGreyImagesToo) {
  RegionTracker with = tracker();
  for (int frame = 0; frame <= 8; ++frame) {
    cv::Mat grey;
    cv::cvtColor(image(frame), grey, cv::COLOR_BGR2GRAY);
    const TrackResult r = frame == 0 ? with.select(grey, 0.0, kRoi) : with.track(grey, 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << r.reason;
    EXPECT_LT(error(r, frame), 0.2);
  }
}

TEST_P(RegionTrackerLens, ShowsOcclusionsWhereTheRawImageHasThem) {
  RegionTracker with = tracker();
  with.select(image(0), 0.0, kRoi);
  const cv::Rect region = image::rawBox(lens_, kRoi.corners(), 0.0);
  const cv::Rect cover(region.x, 0, region.width / 2, kSize.height);
  cv::Mat covered = image(0);
  covered(cover).setTo(cv::Scalar(180, 185, 190));
  const TrackResult r = with.track(covered, 0.04);
  ASSERT_EQ(r.state, State::kTracking) << r.reason;
  EXPECT_LT(error(r, 0), 0.5);
  const cv::Mat mask = with.occlusionMask();
  ASSERT_EQ(mask.size(), kSize);
  const cv::Rect middle(region.x + region.width / 8, region.y + region.height / 4, region.width / 4, region.height / 2);
  EXPECT_GT(cv::countNonZero(mask(middle)), 0.95 * middle.area());
  const cv::Rect clear = middle + cv::Point(region.width / 2, 0);
  EXPECT_LT(cv::countNonZero(mask(clear)), 0.05 * clear.area());
  const cv::Rect around(region.x - 3, region.y - 3, region.width + 6, region.height + 6);
  EXPECT_EQ(cv::countNonZero(mask), cv::countNonZero(mask(around)));
}

// Once by each way of searching.
TEST_P(RegionTrackerLens, FindsTheRegionAgainElsewhere) {
  for (const bool features : {true, false}) {
    TrackerConfig config;
    config.search.features = features;
    config.search.correlation = !features;
    RegionTracker with(config);
    with.setLens(lens_);
    with.select(image(0), 0.0, kRoi);
    const cv::Mat smoke(kSize, CV_8UC3, cv::Scalar(120, 120, 120));
    int frame = 1;
    for (; frame < 4; ++frame) ASSERT_NE(with.track(smoke, 0.04 * frame).state, State::kTracking);
    Eigen::Matrix3d away = Eigen::Matrix3d::Identity();
    away.topRightCorner<2, 1>() << 150.0, 110.0;
    const cv::Mat there = noisy(view_(scene_, away), 7);
    TrackResult r;
    for (int k = 0; k < 12 && r.state != State::kTracking; ++k) r = with.track(there, 0.04 * ++frame);
    ASSERT_EQ(r.state, State::kTracking) << (features ? "features: " : "correlation: ") << r.reason;
    EXPECT_LT(geometry::cornerDistance(r.g, away, kRoi), 0.2);
  }
}

TEST_P(RegionTrackerLens, RefusesARegionThatTheRawImageDoesNotShow) {
  RegionTracker with = tracker();
  for (const geometry::Rectangle& roi :
       {geometry::Rectangle{-400, 40, 120, 110}, geometry::Rectangle{60, 40, 100, 600},
        geometry::Rectangle{1e6, 1e6, 100, 100}, geometry::Rectangle{NAN, 40, 100, 100}}) {
    try {
      with.select(image(0), 0.0, roi);
      ADD_FAILURE() << roi.x;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("ROI"), std::string::npos) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RegionTrackerLens,
                         ::testing::Values(image::Distortion::kPlumbBob, image::Distortion::kRationalPolynomial,
                                           image::Distortion::kEquidistant));

class LensChange : public ::testing::Test {
 protected:
  const cv::Mat image_ = test::tissue(kSize, 3);
  const image::Lens lens_{test::laparoscope(kSize, 330.0)};
  RegionTracker tracker_{TrackerConfig()};
};

TEST_F(LensChange, ResetsAndTheNextImageSaysWhy) {
  tracker_.setLens(lens_);
  tracker_.select(image_, 0.0, kRoi);
  image::LensParameters other = lens_.parameters();
  other.coefficients[0] += 0.01;
  tracker_.setLens(image::Lens(other));
  EXPECT_FALSE(tracker_.hasRoi());
  const TrackResult r = tracker_.track(image_, 0.04);
  EXPECT_EQ(r.state, State::kIdle);
  EXPECT_NE(r.reason.find("lens"), std::string::npos) << r.reason;
  EXPECT_EQ(tracker_.track(image_, 0.08).reason, "no region of interest selected");
  EXPECT_EQ(tracker_.select(image_, 0.12, kRoi).state, State::kTracking);
  tracker_.setLens(std::nullopt);
  EXPECT_EQ(tracker_.track(image_, 0.16).state, State::kIdle);
}

TEST_F(LensChange, IsNoneWhenItIsTheSame) {
  tracker_.setLens(lens_);
  tracker_.select(image_, 0.0, kRoi);
  tracker_.setLens(image::Lens(lens_.parameters()));
  EXPECT_EQ(tracker_.track(image_, 0.04).state, State::kTracking);
}

TEST_F(LensChange, TheLensOutlivesAReset) {
  tracker_.setLens(lens_);
  tracker_.select(image_, 0.0, kRoi);
  tracker_.reset();
  const geometry::Rectangle outside{-400, 40, 120, 110};
  try {
    tracker_.select(image_, 0.04, outside);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("rectified"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
