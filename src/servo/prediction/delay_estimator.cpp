#include "servo/prediction/delay_estimator.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::servo {

namespace {

constexpr double kGrid = 0.005;      // s: the period of commands at the largest rate that can be configured, 200 Hz
constexpr double kCorrelated = 0.1;  // s, correlation time of the errors of reports

}  // namespace

DelayEstimator::DelayEstimator(const DelayConfig& config) : config_(config) {
  validation::throwErrors("delay", validate(config));
  reset(true);
}

void DelayEstimator::reset(bool also_delay) {
  commands_.clear();
  reports_.clear();
  informative_ = false;
  correlation_ = 0.0;
  stddev_ = config_.maximum - config_.minimum;
  if (also_delay) delay_ = config_.initial;
}

bool DelayEstimator::admit(std::deque<Sample>& samples, double time, const scope::Velocity& velocity) {
  if (!std::isfinite(time) || !velocity.vector().allFinite()) return false;
  // The two streams may be out of step, but not by more than a gap.
  const double newest =
      std::max(commands_.empty() ? time : commands_.back().time, reports_.empty() ? time : reports_.back().time);
  const bool back = !samples.empty() && time < samples.back().time;
  const bool gap =
      (!samples.empty() && time > samples.back().time + config_.max_gap) || newest > time + config_.max_gap;
  if (back || gap) reset(false);
  samples.push_back({time, velocity.vector()});
  return true;
}

bool DelayEstimator::command(double time, const scope::Velocity& velocity) {
  if (!admit(commands_, time, velocity)) return false;
  const double keep = time - config_.window - config_.maximum - 10.0 * config_.lag - config_.max_gap;
  while (commands_.size() > 1 && commands_[1].time < keep) commands_.pop_front();
  return true;
}

bool DelayEstimator::report(double time, const scope::Velocity& velocity) {
  if (!admit(reports_, time, velocity)) return false;
  while (reports_.front().time < time - config_.window) reports_.pop_front();
  if (reports_.size() == 1) next_comparison_ = time + 0.5 * config_.window;
  if (time < next_comparison_) return true;
  next_comparison_ = time + config_.period;
  compare();
  return true;
}

void DelayEstimator::compare() {
  informative_ = false;
  correlation_ = 0.0;
  stddev_ = config_.maximum - config_.minimum;
  if (commands_.size() < 2) return;
  resampleCommands();
  const Peak peak = findPeak();
  informative_ = peak.usable && correlation_ >= config_.min_correlation && stddev_ <= config_.max_stddev;
  if (!informative_) return;
  const double most = config_.max_rate * config_.period;
  delay_ += std::clamp(peak.delay - delay_, -most, most);
  delay_ = std::clamp(delay_, config_.minimum, config_.maximum);
}

void DelayEstimator::resampleCommands() {
  grid_start_ = commands_.front().time;
  const double end = std::max(commands_.back().time, reports_.back().time);
  grid_.resize(static_cast<std::size_t>((end - grid_start_) / kGrid) + 2);
  const double forget = config_.lag > 0.0 ? std::exp(-kGrid / config_.lag) : 0.0;
  std::size_t k = 0;
  Eigen::Vector4d executed = commands_.front().velocity;
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    const double time = grid_start_ + kGrid * static_cast<double>(i);
    while (k + 1 < commands_.size() && commands_[k + 1].time <= time) ++k;
    executed = commands_[k].velocity + forget * (executed - commands_[k].velocity);
    grid_[i] = executed;
  }
}

Eigen::Vector4d DelayEstimator::commandAt(double time) const {
  const double position = std::clamp((time - grid_start_) / kGrid, 0.0, static_cast<double>(grid_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(position), grid_.size() - 2);
  const double t = position - static_cast<double>(i);
  return (1.0 - t) * grid_[i] + t * grid_[i + 1];
}

double DelayEstimator::correlationAt(double delay) const {
  Eigen::Array4d u_sum = Eigen::Array4d::Zero();
  Eigen::Array4d m_sum = u_sum;
  Eigen::Array4d uu = u_sum;
  Eigen::Array4d mm = u_sum;
  Eigen::Array4d um = u_sum;
  double n = 0.0;
  for (const Sample& report : reports_) {
    if (report.time - delay < grid_start_) continue;
    const Eigen::Array4d u = commandAt(report.time - delay).array();
    const Eigen::Array4d m = report.velocity.array();
    u_sum += u;
    m_sum += m;
    uu += u * u;
    mm += m * m;
    um += u * m;
    n += 1.0;
  }
  if (n < 10.0) return 0.0;
  const Eigen::Array4d w = weights_.array();
  const double commanded = (w * (uu - u_sum * u_sum / n)).sum();
  const double measured = (w * (mm - m_sum * m_sum / n)).sum();
  const double both = (w * (um - u_sum * m_sum / n)).sum();
  return commanded > 0.0 && measured > 0.0 ? both / std::sqrt(commanded * measured) : 0.0;
}

DelayEstimator::Peak DelayEstimator::findPeak() {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  Eigen::Array4d squares = sum;
  for (const Eigen::Vector4d& u : grid_) {
    sum += u.array();
    squares += u.array().square();
  }
  const auto n = static_cast<double>(grid_.size());
  const Eigen::Array4d variance = squares / n - (sum / n).square();
  const Eigen::Array4d least = config_.min_excitation.vector().array().square();
  for (int k = 0; k < 4; ++k) weights_[k] = variance[k] >= least[k] ? 1.0 / least[k] : 0.0;
  if (!(weights_.maxCoeff() > 0.0)) return {};

  const int count = static_cast<int>(std::ceil((config_.maximum - config_.minimum) / config_.step - 1e-9)) + 1;
  correlations_.clear();
  for (int i = 0; i < count; ++i) correlations_.push_back(correlationAt(config_.minimum + config_.step * i));
  const auto best = std::max_element(correlations_.begin(), correlations_.end());
  correlation_ = std::clamp(*best, 0.0, 1.0);
  // At a bound the true peak may lie beyond it.
  if (best == correlations_.begin() || best + 1 == correlations_.end()) return {};
  const double curvature = (2.0 * best[0] - best[-1] - best[1]) / (config_.step * config_.step);
  if (!(curvature > 0.0) || !(correlation_ > 0.0)) return {};
  const double offset = 0.5 * (best[1] - best[-1]) / (2.0 * best[0] - best[-1] - best[1]) * config_.step;
  const double independent = std::max(1.0, (reports_.back().time - reports_.front().time) / kCorrelated);
  stddev_ = std::sqrt((1.0 - correlation_ * correlation_) / (correlation_ * curvature * independent));
  return {true, config_.minimum + config_.step * static_cast<double>(best - correlations_.begin()) + offset};
}

}  // namespace laparoscope_servo::servo
