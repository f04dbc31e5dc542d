#include "laparoscope_servo/motion/anchored_motion.h"

#include <limits>
#include <vector>

#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/validation/error_report.h"
#include "motion/motion_sequence.h"

namespace laparoscope_servo::motion {

namespace {

using features::Reason;
using features::State;

constexpr double kEnoughInView = 0.25;  // share of the anchor, to be compared with
constexpr double kMostDrift = 5.0;      // px: a larger expected error of what was integrated is not believed
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Share of points, spread over the frame, that g takes into it.
double shareInView(const Eigen::Matrix3d& g, const geometry::Rectangle& frame) {
  constexpr int kAlong = 10;
  int seen = 0;
  for (int j = 0; j < kAlong; ++j) {
    for (int i = 0; i < kAlong; ++i) {
      const Eigen::Vector3d p =
          g * Eigen::Vector3d((i + 0.5) / kAlong * frame.width, (j + 0.5) / kAlong * frame.height, 1.0);
      const bool inside =
          p.z() > 0.0 && p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= frame.width * p.z() && p.y() <= frame.height * p.z();
      seen += inside ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / (kAlong * kAlong);
}

}  // namespace

class AnchoredMotion::Implementation {
 public:
  explicit Implementation(const MotionConfig& config)
      : keeper_(config.state), sequence_(config), estimator_(config, true), config_(config) {
    starts_.reserve(MotionAligner::kMostStarts);
  }

  const AnchoredResult& begin(const cv::Mat& image, double stamp, const cv::Mat& mask);
  const AnchoredResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion,
                              const cv::Mat& mask);
  void reset();

  const AnchoredResult& result() const { return result_; }
  const MotionResult& step() const { return sequence_.result(); }
  const MotionSupport& support() const { return sequence_.support(); }

 private:
  void anchor(const cv::Mat& image, double stamp, const cv::Mat& mask);
  Reason integrate();
  Reason compare();
  double expectedError() const { return errorAtCorners(frame_.corners(), frame_.centre(), covariance_); }

  features::StateKeeper keeper_;
  MotionSequence sequence_;
  MotionEstimator estimator_;
  MotionConfig config_;
  MotionImage anchor_;
  geometry::Rectangle frame_;
  double anchored_stamp_ = 0.0;
  // The motion to the last image, and its covariance; valid if known_.
  bool known_ = false;
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity();
  tracking::Matrix8d covariance_ = tracking::Matrix8d::Zero();
  std::vector<Eigen::Matrix3d> starts_;
  AnchoredResult result_;
};

void AnchoredMotion::Implementation::anchor(const cv::Mat& image, double stamp, const cv::Mat& mask) {
  anchor_.take(image, mask, config_);
  estimator_.setReference(anchor_);
  estimator_.forget();
  frame_ = {0.0, 0.0, static_cast<double>(image.cols), static_cast<double>(image.rows)};
  keeper_.select(stamp);
  anchored_stamp_ = stamp;
  known_ = true;
  g_.setIdentity();
  covariance_.setZero();
  result_ = AnchoredResult();
  result_.state = State::kTracking;
  result_.reason = Reason::kNone;
  result_.field.centre = frame_.centre();
  result_.anchored = true;
  result_.share = result_.in_view = 1.0;
}

const AnchoredResult& AnchoredMotion::Implementation::begin(const cv::Mat& image, double stamp, const cv::Mat& mask) {
  sequence_.begin(image, stamp, std::nullopt, mask);
  anchor(image, stamp, mask);
  return result_;
}

void AnchoredMotion::Implementation::reset() {
  sequence_.reset(Reason::kReset);
  keeper_.reset(Reason::kReset);
  known_ = false;
  result_ = AnchoredResult();
  result_.reason = Reason::kReset;
}

// Eq. (10), with homographies in place of sums.
Reason AnchoredMotion::Implementation::integrate() {
  if (!sequence_.believed()) {
    known_ = false;
    return step().reason;
  }
  g_ = step().g * g_;
  covariance_ += sequence_.covariance();
  if (known_ && !(expectedError() <= kMostDrift)) {
    known_ = false;
    return Reason::kUncertain;
  }
  return Reason::kNone;
}

// Where the chain is broken the anchor is looked for where it was last, and where it has been at the beginning.
Reason AnchoredMotion::Implementation::compare() {
  if (known_ && shareInView(g_, frame_) < kEnoughInView) return Reason::kOutside;
  starts_.assign(1, g_);
  if (!known_) starts_.push_back(Eigen::Matrix3d::Identity());
  const MotionEstimate& found = estimator_.estimate(anchor_, sequence_.last(), starts_, frame_.corners(), true);
  if (found.why != Reason::kNone) return found.why;
  if (shareInView(found.at.g, frame_) < kEnoughInView) return Reason::kOutside;
  const double surprise = geometry::cornerDistance(found.at.g, g_, frame_);
  if (known_ && !(surprise <= mostSurprise(expectedError()))) return Reason::kJump;
  g_ = found.at.g;
  covariance_ = found.covariance;
  result_.share = found.share;
  return Reason::kNone;
}

const AnchoredResult& AnchoredMotion::Implementation::track(const cv::Mat& image, double stamp,
                                                            const std::optional<Eigen::Matrix3d>& motion,
                                                            const cv::Mat& mask) {
  const MotionResult& step = sequence_.track(image, stamp, motion, mask);
  if (step.state == State::kIdle) {
    anchor(image, stamp, mask);
    return result_;
  }
  result_.share = 0.0;
  const Reason broken = integrate();
  const Reason missed = compare();
  result_.anchored = missed == Reason::kNone;
  if (result_.anchored) {
    known_ = true;
    anchored_stamp_ = stamp;
  }
  keeper_.step(known_ ? Reason::kNone : broken != Reason::kNone ? broken : missed, stamp);
  result_.state = keeper_.state();
  result_.reason = keeper_.reason();
  result_.g = g_;
  result_.field = fieldOf(g_, frame_.centre());
  result_.since_anchored = stamp - anchored_stamp_;
  result_.in_view = shareInView(g_, frame_);
  result_.covariance = covariance_;
  result_.expected_error = expectedError();
  if (result_.state != State::kTracking) {
    features::setUnknown(result_.covariance);
    result_.expected_error = kInfinite;
  }
  return result_;
}

AnchoredMotion::AnchoredMotion(const MotionConfig& config) {
  validation::throwErrors("motion", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}

AnchoredMotion::AnchoredMotion(AnchoredMotion&&) noexcept = default;
AnchoredMotion& AnchoredMotion::operator=(AnchoredMotion&&) noexcept = default;
AnchoredMotion::~AnchoredMotion() = default;

const AnchoredResult& AnchoredMotion::begin(const cv::Mat& image, double stamp, const cv::Mat& mask) {
  return implementation_->begin(image, stamp, mask);
}

const AnchoredResult& AnchoredMotion::track(const cv::Mat& image, double stamp,
                                            const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& mask) {
  return implementation_->track(image, stamp, motion, mask);
}

void AnchoredMotion::reset() {
  implementation_->reset();
}

const AnchoredResult& AnchoredMotion::result() const {
  return implementation_->result();
}

const MotionResult& AnchoredMotion::step() const {
  return implementation_->step();
}

const cv::Mat1b& AnchoredMotion::support() const {
  return implementation_->support().map();
}

cv::Size AnchoredMotion::cellSize() const {
  return implementation_->support().cellSize();
}

}  // namespace laparoscope_servo::motion
