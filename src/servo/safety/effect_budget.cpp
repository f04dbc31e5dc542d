#include "servo/safety/effect_budget.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "servo/safety/effect_explanations.h"

namespace laparoscope_servo::servo {

namespace {

// Log of the ratio of likelihoods, the picture as it should be over a fault: from the first on a fault is closed, below
// the second it is open again. Measured with simulate_servo, 200 starts of large_starts: with 4 in the place of 3 some
// three healthy starts more use up what they may go.
constexpr double kClosed = 3.0;
constexpr double kOpened = 1.0;
// So much is kept, and forgotten within this time [s]: a fault that nothing speaks against any more is open again after
// 23 s, memory times the log of most over opened.
constexpr double kMost = 10.0;
constexpr double kMemory = 10.0;

}  // namespace

struct EffectBudget::Fault {
  EffectExplanation explanation;
  double log_likelihood = 0.0;
  bool open = true;
  Eigen::Vector4d since = Eigen::Vector4d::Zero();  // where it was opened

  // Which share of pan and tilt goes wrong, and of which: the largest is 1, or all are 0.
  Eigen::Matrix2d wrongOfTurn(double turned) const {
    // A pan to the one side lets the picture go to the other, a tilt does not.
    const Eigen::Matrix2d seen =
        Eigen::Rotation2Dd(turned).toRotationMatrix() * Eigen::Vector2d(-1.0, 1.0).asDiagonal();
    const Eigen::Matrix2d does = seen.transpose() * explanation.picture * seen * explanation.arm.head<2>().asDiagonal();
    const Eigen::Matrix2d wrong = Eigen::Matrix2d::Identity() - does;
    const double most = Eigen::JacobiSVD<Eigen::Matrix2d>(wrong).singularValues()[0];
    return wrong / std::max(most, 0.1);
  }
  // A single axis that is reversed, as spin in a mirrored picture, and is to go a short way beside a long one, shows
  // too little: healthy loops would use up what they may go.
  bool counts() const { return !explanation.picture.isIdentity() || explanation.frozen(); }
};

EffectBudget::EffectBudget(const EffectConfig& config) : config_(config) {
  for (const EffectExplanation& explanation : effectExplanations()) {
    if (explanation.fault.empty()) {
      good_.push_back(0.0);
    } else {
      faults_.emplace_back();
      faults_.back().explanation = explanation;
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
    fault.open = !alike && !(against >= (fault.open ? kClosed : kOpened));
    if (!fault.open) fault.since = done_;
  }
}

double EffectBudget::spent() const {
  double most = 0.0;
  for (const Fault& fault : faults_) {
    if (!fault.open || !fault.counts()) continue;
    const Eigen::Vector4d moved = moved_ - fault.since;
    double turn = (fault.wrongOfTurn(turned_) * moved.head<2>()).norm();
    if (fault.explanation.frozen()) {
      turn = std::max(turn, std::abs(moved[2]));
      most = std::max(most, std::abs(moved[3]) / config_.unconfirmed_insertion);
    }
    most = std::max(most, turn / config_.unconfirmed_turn);
  }
  return most;
}

double EffectBudget::aside() const {
  double most = 0.0;
  for (const Fault& fault : faults_) {
    if (!fault.open || !fault.counts()) continue;
    const Eigen::Vector4d moved = (moved_ - fault.since).cwiseAbs();
    most = std::max({most, moved[2] / config_.unconfirmed_turn, moved[3] / config_.unconfirmed_insertion});
  }
  return most;
}

}  // namespace laparoscope_servo::servo
