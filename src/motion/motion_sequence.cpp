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

cv::Mat cut(const cv::Mat& image, const cv::Rect& box) {
  return image.empty() ? image : image(box);
}

}  // namespace

MotionSequence::MotionSequence(const MotionConfig& config)
    : config_(config), keeper_(config.state), estimator_(config), anchor_(config) {
  starts_.reserve(MotionAligner::kMostStarts);
}

void MotionSequence::reset(Reason reason) {
  sequence_.end();
  window_.reset();
  believed_ = false;
  velocity_.setZero();
  estimator_.forget();
  keeper_.reset(reason);
  result_ = MotionResult();
  result_.reason = reason;
}

void MotionSequence::start(const cv::Mat& image, double stamp, const std::optional<geometry::Rectangle>& region,
                           const cv::Mat& mask, Reason reason) {
  if (!region) last_.take(image, mask, config_);
  reset(reason);
  sequence_.begin(image, stamp);
  box_ = cv::Rect({}, image.size());
  region_ =
      region.value_or(geometry::Rectangle{0.0, 0.0, static_cast<double>(image.cols), static_cast<double>(image.rows)})
          .corners();
  if (region) {
    window_.emplace(*region, image.size());
    anchor_.begin(image, mask, window_->about(region_), region_);
    keep(image, mask);
  }
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

void MotionSequence::keep(const cv::Mat& image, const cv::Mat& mask) {
  image.copyTo(picture_);
  if (mask.empty()) {
    mask_.release();
  } else {
    mask.copyTo(mask_);
  }
}

// Takes the image as the current one. With a window, both images are cut to the part around the region.
void MotionSequence::take(const cv::Mat& image, const cv::Mat& mask) {
  if (!window_) {
    current_.take(image, mask, config_);
    return;
  }
  box_ = window_->about(region_);
  last_.take(cut(picture_, box_), cut(mask_, box_), config_);
  current_.take(cut(image, box_), cut(mask, box_), config_);
  keep(image, mask);
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
  expected_ = starts_.front();
  const Eigen::Matrix3d image_from_box = imageFromBox(box_);
  const Eigen::Matrix3d box_from_image = image_from_box.inverse();
  for (Eigen::Matrix3d& g : starts_) g = box_from_image * g * image_from_box;
  estimator_.setReference(last_);
  const MotionEstimate& found =
      estimator_.estimate(last_, current_, starts_, geometry::apply(box_from_image, region_), !window_);
  believed_ = found.why == Reason::kNone;
  const Eigen::Matrix<double, 8, 8> to_image = fieldAbout(result_.field.centre - middleOf(box_));
  covariance_ = to_image * found.covariance * to_image.transpose();
  result_.g = believed_ ? image_from_box * found.at.g * box_from_image : expected_;
  tell(found);
  return found.why;
}

void MotionSequence::tell(const MotionEstimate& found) {
  result_.field = fieldOf(result_.g, result_.field.centre);
  result_.covariance = covariance_;
  result_.gain = found.at.gain;
  result_.offset = found.at.offset;
  result_.sigma = found.at.sigma;
  result_.usable = found.usable;
  result_.share = found.share;
  result_.expected_error = found.expected_error;
  result_.iterations = found.at.iterations;
}

// The region by its anchor. Once a step was not seen, further steps may be those of what lies in its place: only the
// anchor tells, and it may do so where the step from the last image is not seen.
Reason MotionSequence::compare(Reason why) {
  const Eigen::Matrix3d before = anchor_.motion();
  const bool is_step = believed_ && anchor_.isKnown();
  anchor_.goOn(is_step ? result_.g : expected_, is_step ? result_.expected_error : kInfinite);
  const bool is_compared = anchor_.compare(current_, box_);
  region_ = anchor_.region();
  // A part of the region that is left in the image is not compared: it may be what has come in its place.
  believed_ = why != Reason::kOutside && (is_compared || anchor_.isKnown());
  if (!believed_) {
    result_.g = expected_;
    result_.field = fieldOf(result_.g, result_.field.centre);
    return why == Reason::kNone ? Reason::kNotSeen : why;
  }
  if (is_step) return Reason::kNone;
  result_.g = anchor_.motion() * before.inverse();
  result_.g /= std::cbrt(result_.g.determinant());
  const Eigen::Matrix<double, 8, 8> to_image = fieldAbout(result_.field.centre - anchor_.middle());
  covariance_ = to_image * anchor_.found().covariance * to_image.transpose();
  tell(anchor_.found());
  return Reason::kNone;
}

const MotionResult& MotionSequence::track(const cv::Mat& image, double stamp,
                                          const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& mask) {
  check(image, stamp, mask);
  const Reason anew = sequence_.judge(image, stamp);
  if (anew != Reason::kNone) {
    start(image, stamp, std::nullopt, mask, anew);
    return result_;
  }
  take(image, mask);
  const Eigen::Vector2d centre = result_.field.centre;
  result_ = MotionResult();
  result_.field.centre = centre;
  result_.interval = stamp - sequence_.stamp();
  const bool first = keeper_.state() == State::kIdle;
  if (first) keeper_.select(stamp);
  Reason why = estimate(motion);
  if (window_) why = compare(why);
  if (!believed_) {
    velocity_ *= config_.velocity_damping;
  } else if (result_.interval > 0.0) {
    velocity_ = result_.field.a / result_.interval;
  }
  keeper_.step(why, stamp);
  result_.state = keeper_.state();
  result_.reason = keeper_.reason();
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
