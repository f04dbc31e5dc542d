#include "servo/safety/effect_budget.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/largest.h"
#include "servo/safety/effect_explanations.h"

namespace laparoscope_servo::servo {

namespace {

// Log likelihood ratio of the correct picture over a fault: from kClosed on the fault is excluded, below the next
// constant it is open again. Measured with simulate_servo, 200 starts of large_starts: with 4 instead of 3 about three
// more healthy starts use up the budget.
constexpr double kClosed = 3.0;
constexpr double kOpened = 1.0;
// Thresholds for a fault of a single axis, whose motion may be short beside that of the others and gives less evidence.
// With 3 and 1, 8 of 400 healthy starts were held, one of them for good; with these values 1 was. The largest motion of
// an axis in the wrong direction did not change (300 starts each of effect_insertion_reversed and
// effect_spin_reversed).
constexpr double kClosedAxis = 1.5;
constexpr double kOpenedAxis = 0.5;
// The ratio is limited to kMost, and decays with the time constant below [s]: without further evidence a fault is open
// again after 23 s, the time constant times the log of kMost over the threshold of opening.
constexpr double kMost = 10.0;
constexpr double kMemory = 10.0;

// NaN if one of them is: a motion that is not known is not one that used nothing up.
double largest(double a, double b, double c) {
  return robust::largest(robust::largest(a, b), c);
}

}  // namespace

// A fault hypothesis, with the share of a motion that would go wrong under it, at most 1.
struct EffectBudget::Fault {
  explicit Fault(const EffectExplanation& fault)
      : explanation(fault),
        of_picture(Eigen::Matrix2d::Identity() - fault.picture),
        of_arm(Eigen::Vector4d::Ones() - fault.arm) {
    const double most = Eigen::JacobiSVD<Eigen::Matrix2d>(of_picture).singularValues()[0];
    if (most > 0.0) of_picture /= most;
    if (!of_arm.isZero()) of_arm /= of_arm.maxCoeff();
  }

  EffectExplanation explanation;
  Eigen::Matrix2d of_picture;
  Eigen::Vector4d of_arm;
  double log_likelihood = 0.0;
  bool open = true;
  Eigen::Vector4d since = Eigen::Vector4d::Zero();  // displacement at which it was opened

  // (turn [rad], insertion [m]) that go wrong in a displacement, with a camera that is turned about the shaft.
  Eigen::Vector2d wrong(const Eigen::Vector4d& displacement, const Eigen::Matrix2d& turned) const {
    // A pan moves the picture in the opposite direction, a tilt in the same one.
    const Eigen::Vector2d seen = turned * Eigen::Vector2d(-displacement[0], displacement[1]);
    const Eigen::Vector4d of_axes = of_arm.cwiseProduct(displacement).cwiseAbs();
    return {largest((of_picture * seen).norm(), of_axes.head<2>().norm(), of_axes[2]), of_axes[3]};
  }
  bool ofPicture() const { return !of_picture.isZero() || explanation.frozen(); }
  double closed() const { return ofPicture() ? kClosed : kClosedAxis; }
  double opened() const { return ofPicture() ? kOpened : kOpenedAxis; }
};

EffectBudget::EffectBudget(const EffectConfig& config) : config_(config) {
  for (const EffectExplanation& explanation : effectExplanations()) {
    if (explanation.fault.empty()) {
      good_.push_back(0.0);
    } else {
      faults_.emplace_back(explanation);
    }
  }
}

EffectBudget::~EffectBudget() = default;
EffectBudget::EffectBudget(EffectBudget&&) noexcept = default;
EffectBudget& EffectBudget::operator=(EffectBudget&&) noexcept = default;

void EffectBudget::restart() {
  interrupt();
  for (Fault& fault : faults_) fault.since = moved_;
}

void EffectBudget::interrupt() {
  std::fill(good_.begin(), good_.end(), 0.0);
  for (Fault& fault : faults_) {
    fault.log_likelihood = 0.0;
    if (!fault.open) fault.since = done_;
    fault.open = true;
  }
}

void EffectBudget::command(const Eigen::Vector4d& displacement, bool for_view) {
  moved_ += displacement;
  if (for_view) return;
  for (Fault& fault : faults_) fault.since += displacement;
}

void EffectBudget::see(double dt, const std::vector<double>& log_likelihoods, const Eigen::Vector4d& pending,
                       double turned, bool breath_known) {
  const double kept = std::exp(-dt / kMemory);
  done_ = moved_ - pending;
  turned_ = turned;
  for (std::size_t k = 0; k < good_.size(); ++k) good_[k] = kept * good_[k] + log_likelihoods[k];
  const double best = *std::max_element(good_.begin(), good_.end());
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    Fault& fault = faults_[k];
    fault.log_likelihood = kept * fault.log_likelihood + log_likelihoods[good_.size() + k];
    fault.log_likelihood = std::max(fault.log_likelihood, best - kMost);
    const double against = best - fault.log_likelihood;
    const bool alike = fault.explanation.frozen() && breath_known;
    fault.open = !alike && !(against >= (fault.open ? fault.closed() : fault.opened()));
    if (!fault.open) fault.since = done_;
  }
}

double EffectBudget::spent() const {
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(turned_).toRotationMatrix();
  double most = 0.0;
  for (const Fault& fault : faults_) {
    if (!fault.open) continue;
    const Eigen::Vector2d wrong = fault.wrong(moved_ - fault.since, turned);
    most = largest(most, wrong[0] / config_.unconfirmed_turn, wrong[1] / config_.unconfirmed_insertion);
  }
  return most;
}

double EffectBudget::aside() const {
  double most = 0.0;
  for (const Fault& fault : faults_) {
    if (!fault.open || !fault.ofPicture()) continue;
    const Eigen::Vector4d moved = (moved_ - fault.since).cwiseAbs();
    most = largest(most, moved[2] / config_.unconfirmed_turn, moved[3] / config_.unconfirmed_insertion);
  }
  return most;
}

}  // namespace laparoscope_servo::servo
