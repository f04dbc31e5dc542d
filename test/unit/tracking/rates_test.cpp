// Times are in seconds, lengths relative to the region: the same sequence at another rate of the camera, or with more
// or fewer pixels, is tracked, lost and found again alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(300, 240);  // px, once the size
const geometry::Rectangle kRoi = {95, 65, 104, 104};
constexpr double kDuration = 2.4;  // s
constexpr double kStep = 0.08;     // s, in which every rate has an image, or one nearby

// px of once the size.
Eigen::Matrix3d motion(double t) {
  const double angle = 0.1 * std::sin(2.5 * t);
  Eigen::Matrix3d g;
  g << std::cos(angle), -std::sin(angle), 14.0 * std::sin(2.2 * t) + 15.0 * angle, std::sin(angle), std::cos(angle),
      9.0 * std::sin(1.7 * t) - 15.0 * angle, 0.0, 8e-5 * std::sin(2.0 * t), 1.0;
  return g;
}

// A shaft comes in from the left until it covers 45 % of the region, and goes again.
double coveredAt(double t) {
  return 0.45 * std::clamp(std::min(t - 0.4, 1.2 - t) / 0.2, 0.0, 1.0);
}

// Then everything is covered.
bool hiddenAt(double t) {
  return t > 1.4 && t < 1.7;
}

struct Camera {
  double rate = 25.0;  // Hz
  double size = 1.0;   // px per px of once the size
};

// Once the size to this size; both have the centre of their first pixel at (0, 0).
Eigen::Matrix3d sizing(double size) {
  Eigen::Matrix3d s;
  s << size, 0.0, 0.5 * (size - 1.0), 0.0, size, 0.5 * (size - 1.0), 0.0, 0.0, 1.0;
  return s;
}

class Sequence {
 public:
  Sequence(const Camera& camera, double bend) : camera_(camera), bend_(bend), sizing_(sizing(camera.size)) {
    scene_ = resized(test::tissue(kSize, 31));
    other_ = resized(test::tissue(kSize, 32));
  }

  geometry::Rectangle roi() const {
    const double s = camera_.size;
    return {s * kRoi.x, s * kRoi.y, s * kRoi.width, s * kRoi.height};
  }
  Eigen::Matrix3d g(double t) const { return sizing_ * motion(t) * sizing_.inverse(); }

  cv::Mat image(double t) const {
    const unsigned seed = 100 + static_cast<unsigned>(std::lround(1000.0 * t));
    if (hiddenAt(t)) return test::view(other_, g(t), 1.0, 0.0, 2.0, seed);
    cv::Mat seen = test::view(scene_, g(t), 1.0, 0.0, 2.0, seed);
    const double end = (kRoi.x + coveredAt(t) * kRoi.width) * camera_.size;
    if (bend_ > 0.0) seen = bent(seen, bend_ * std::min(t, 1.0));
    if (coveredAt(t) > 0.0) seen.colRange(0, static_cast<int>(end)).setTo(cv::Scalar(170, 175, 180));
    return seen;
  }

 private:
  // Waves of the tissue, 100 to 126 px long.
  cv::Mat bent(const cv::Mat& image, double amount) const {
    cv::Mat1f x(image.size()), y(image.size());
    const double s = camera_.size;
    for (int j = 0; j < image.rows; ++j) {
      for (int i = 0; i < image.cols; ++i) {
        x(j, i) = static_cast<float>(i + s * amount * std::sin(j / s / 20.0));
        y(j, i) = static_cast<float>(j + s * amount * std::sin(i / s / 16.0));
      }
    }
    cv::Mat result;
    cv::remap(image, result, x, y, cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    return result;
  }
  cv::Mat resized(const cv::Mat& image) const {
    cv::Mat result;
    const int method = camera_.size < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC;
    cv::resize(image, result, cv::Size(), camera_.size, camera_.size, method);
    return result;
  }

  Camera camera_;
  double bend_;  // px of once the size, by which the tissue is bent after a second
  Eigen::Matrix3d sizing_;
  cv::Mat scene_, other_;
};

struct Outcome {
  std::vector<bool> tracking;          // each kStep
  std::vector<double> clear, covered;  // px of once the size, of the worst corner
  double found = -1.0;                 // s
  int lies = 0;                        // images
};

Outcome run(const Camera& camera, double bend) {
  const Sequence sequence(camera, bend);
  RegionTracker tracker{TrackerConfig()};
  tracker.select(sequence.image(0.0), 0.0, sequence.roi());
  Outcome outcome;
  for (int k = 1; k / camera.rate < kDuration; ++k) {
    const double t = k / camera.rate;
    const TrackResult& result = tracker.track(sequence.image(t), t);
    const bool tracking = result.state == State::kTracking;
    const double error = geometry::cornerDistance(result.g, sequence.g(t), sequence.roi()) / camera.size;
    if (tracking && (hiddenAt(t) || error > 5.0)) ++outcome.lies;
    if (tracking) (coveredAt(t) > 0.0 ? outcome.covered : outcome.clear).push_back(error);
    if (tracking && outcome.found < 0.0 && t > 1.7) outcome.found = t;
    if (std::floor((t + 1e-9) / kStep) > std::floor((t - 1.0 / camera.rate + 1e-9) / kStep))
      outcome.tracking.push_back(tracking);
  }
  return outcome;
}

double median(std::vector<double> values) {
  return values.empty() ? -1.0 : robust::median(values);
}

// The worst corner, px of once the size.
double worst(const std::vector<double>& errors) {
  return errors.empty() ? -1.0 : *std::max_element(errors.begin(), errors.end());
}

std::string text(const Camera& camera) {
  std::ostringstream text;
  text << camera.rate << " Hz, size " << camera.size;
  return text.str();
}

// Images that are lost at `a` and not at `b`, or the other way, in steps of kStep.
int differentStates(const Outcome& a, const Outcome& b) {
  int different = 0;
  for (std::size_t k = 0; k < std::min(a.tracking.size(), b.tracking.size()); ++k)
    different += a.tracking[k] != b.tracking[k];
  return different;
}

constexpr Camera kUsual = {25.0, 1.0};
const Camera kOthers[] = {{12.5, 1.0}, {60.0, 1.0}, {25.0, 0.5}, {25.0, 2.0}, {25.0, 4.0}};
const Camera kLarge = {25.0, 6.0};  // the region's finest level is coarser than the image

TEST(Rates, AFlatRegionIsTrackedLostAndFoundAlike) {
  const Outcome usual = run(kUsual, 0.0);
  ASSERT_LT(worst(usual.clear), 0.2);
  std::vector<Camera> others(std::begin(kOthers), std::end(kOthers));
  others.push_back(kLarge);
  for (const Camera& camera : others) {
    SCOPED_TRACE(text(camera));
    const Outcome outcome = run(camera, 0.0);
    EXPECT_EQ(outcome.lies, 0);
    // The first image after it was hidden may be one period later.
    EXPECT_LE(differentStates(outcome, usual), 1);
    EXPECT_NEAR(outcome.found, usual.found, 0.15);
    EXPECT_LT(median(outcome.clear), 0.1);
    EXPECT_LT(median(outcome.covered), 0.3);
  }
}

// Tissue bends by so many px of once the size, four times as many at four times the size: what a plane misses is the
// same share of the region.
TEST(Rates, TissueThatBendsIsTrackedLostAndFoundAlike) {
  constexpr double kBend = 1.25;
  const Outcome usual = run(kUsual, kBend);
  for (const Camera& camera : kOthers) {
    SCOPED_TRACE(text(camera));
    const Outcome outcome = run(camera, kBend);
    EXPECT_LE(differentStates(outcome, usual), 1);
    EXPECT_NEAR(outcome.found, usual.found, 0.15);
    EXPECT_LT(worst(outcome.clear), 1.5 * worst(usual.clear));
    EXPECT_LT(worst(outcome.covered), 1.5 * worst(usual.covered));
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
