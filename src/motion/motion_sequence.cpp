#include "motion/motion_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/image/image_type.h"

namespace laparoscope_servo::motion {

namespace {

using features::Reason;
using features::State;

constexpr int kLeastImage = 64;        // px
constexpr double kLeastRegion = 48.0;  // px
constexpr double kInfinite = std::numeric_limits<double>::infinity();

void check(const cv::Mat& image, double stamp, const cv::Mat& mask) {
  if (image.cols < kLeastImage || image.rows < kLeastImage) {
    std::ostringstream text;
    text << "image of " << image.cols << " x " << image.rows << " px, expected at least " << kLeastImage << " x "
         << kLeastImage;
    throw std::invalid_argument(text.str());
  }
  image::checkImage(image, stamp);
  image::checkMask(mask, image);
}

void check(const geometry::Rectangle& region, const cv::Mat& image) {
  const bool fits = region.width >= kLeastRegion && region.height >= kLeastRegion && region.x >= 0.0 &&
                    region.y >= 0.0 && region.x + region.width <= image.cols && region.y + region.height <= image.rows;
  if (fits) return;
  std::ostringstream text;
  text << "region of " << region.width << " x " << region.height << " px at (" << region.x << ", " << region.y
       << "), expected at least " << kLeastRegion << " x " << kLeastRegion << " px within the image of " << image.cols
       << " x " << image.rows;
  throw std::invalid_argument(text.str());
}

}  // namespace

MotionSequence::MotionSequence(const MotionConfig& config)
    : config_(config), keeper_(config.state), estimator_(config) {
  starts_.reserve(MotionAligner::kMostStarts);
}

void MotionSequence::reset(Reason reason) {
  sequence_.end();
  has_region_ = believed_ = false;
  velocity_.setZero();
  estimator_.forget();
  keeper_.reset(reason);
  result_ = MotionResult();
  result_.reason = reason;
}

void MotionSequence::start(const cv::Mat& image, double stamp, const std::optional<geometry::Rectangle>& region,
                           const cv::Mat& mask, Reason reason) {
  last_.take(image, mask, config_);
  reset(reason);
  sequence_.begin(image, stamp);
  has_region_ = region.has_value();
  region_ =
      region.value_or(geometry::Rectangle{0.0, 0.0, static_cast<double>(image.cols), static_cast<double>(image.rows)})
          .corners();
  result_.region = region_;
  result_.field.centre = Eigen::Vector2d(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
}

const MotionResult& MotionSequence::begin(const cv::Mat& image, double stamp,
                                          const std::optional<geometry::Rectangle>& region, const cv::Mat& mask) {
  check(image, stamp, mask);
  if (region) check(*region, image);
  start(image, stamp, region, mask, Reason::kFirstImage);
  return result_;
}

Eigen::Matrix3d MotionSequence::predicted(double interval) const {
  MotionField field;
  field.centre = result_.field.centre;
  field.a = config_.velocity_damping * interval * velocity_;
  return homographyOf(field);
}

// Fills in the result when the motion is believed, and says why it is not.
Reason MotionSequence::estimate(const std::optional<Eigen::Matrix3d>& motion) {
  starts_.clear();
  const bool given = motion && motion->allFinite() && motion->determinant() > 0.0 &&
                     fieldOf(*motion, result_.field.centre).a.allFinite();
  if (given) starts_.push_back(*motion / std::cbrt(motion->determinant()));
  starts_.push_back(predicted(result_.interval));
  starts_.push_back(Eigen::Matrix3d::Identity());
  estimator_.setReference(last_);
  const MotionEstimate& found = estimator_.estimate(last_, current_, starts_, region_, !has_region_);
  believed_ = found.why == Reason::kNone;
  covariance_ = found.covariance;
  result_.g = believed_ ? found.at.g : starts_.front();
  result_.field = fieldOf(result_.g, result_.field.centre);
  result_.covariance = found.covariance;
  result_.gain = found.at.gain;
  result_.offset = found.at.offset;
  result_.sigma = found.at.sigma;
  result_.usable = found.usable;
  result_.share = found.share;
  result_.expected_error = found.expected_error;
  result_.iterations = found.at.iterations;
  if (!believed_) {
    velocity_ *= config_.velocity_damping;
  } else if (result_.interval > 0.0) {
    velocity_ = result_.field.a / result_.interval;
  }
  return found.why;
}

const MotionResult& MotionSequence::track(const cv::Mat& image, double stamp,
                                          const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& mask) {
  check(image, stamp, mask);
  const Reason anew = sequence_.judge(image, stamp);
  if (anew != Reason::kNone) {
    start(image, stamp, std::nullopt, mask, anew);
    return result_;
  }
  current_.take(image, mask, config_);
  const Eigen::Vector2d centre = result_.field.centre;
  result_ = MotionResult();
  result_.field.centre = centre;
  result_.interval = stamp - sequence_.stamp();
  const bool first = keeper_.state() == State::kIdle;
  if (first) keeper_.select(stamp);
  const Reason why = estimate(motion);
  keeper_.step(why, stamp);
  result_.state = keeper_.state();
  result_.reason = keeper_.reason();
  if (has_region_) region_ = geometry::apply(result_.g, region_);
  result_.region = region_;
  if (result_.state != State::kTracking) {
    result_.expected_error = kInfinite;
    features::setUnknown(result_.covariance);
  }
  std::swap(last_, current_);
  sequence_.goOn(stamp);
  return result_;
}

}  // namespace laparoscope_servo::motion
