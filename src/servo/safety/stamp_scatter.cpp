#include "servo/safety/stamp_scatter.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

// s: the speed is taken over so long, so that the scatter itself hardly counts; a scope needs 0.1 s to full speed.
constexpr double kBaseline = 0.2;
constexpr double kMemory = 10.0;  // s, over which it is forgotten: a grabber does not change
// s, further off is no scatter of stamps but another picture: images that are older do not count anyway
// (safety/max_task_error_age), and half of it is as good as a period of three lost ones at 25 Hz.
constexpr double kFurthest = 0.15;
// s, more is never taken for granted: evenly off by up to 0.1 s to both sides is 0.058.
constexpr double kMost = 0.06;
// Of the noise's variance: what stays below is no scatter. Pictures are seldom twice as noisy as their corner error
// says.
constexpr double kNoise = 2.0;
// s: an image counts in half by which the picture moves by the noise within it. With 0.005 one of 200 starts with the
// spin reversed turned 3.6 degrees away, with this 2.5; else the two are equal.
constexpr double kResolved = 0.0015;
constexpr double kWorth = 3.0;  // images, that kBefore is worth

StampScatter::Features change(const StampScatter::Features& from, const StampScatter::Features& to) {
  StampScatter::Features difference = to - from;
  difference[3] = std::remainder(difference[3], 2.0 * M_PI);
  return difference;
}

}  // namespace

void StampScatter::restart() {
  images_.clear();
  speed_.setZero();
}

void StampScatter::take(double time, const Features& seen, const std::vector<Features>& left, const Features& variance,
                        const Features& expected) {
  square_.resize(left.size(), 0.0);
  if (!images_.empty()) forget(time - images_.back().time);
  images_.push_back({time, seen, left});
  while (images_.size() > 3 && time - images_[1].time >= kBaseline) images_.pop_front();
  measureSpeed(expected);
  if (images_.size() >= 3) compare(variance);
  const double least = square_.empty() ? 0.0 : *std::min_element(square_.begin(), square_.end());
  seconds_ = std::min(kMost, std::sqrt((least + kWorth * kBefore * kBefore) / (moved_ + kWorth)));
}

void StampScatter::forget(double dt) {
  const double kept = std::exp(-dt / kMemory);
  for (double& value : square_) value *= kept;
  moved_ *= kept;
}

void StampScatter::measureSpeed(const Features& expected) {
  const Image& first = images_.front();
  const Image& last = images_.back();
  const double span = std::max(last.time - first.time, kBaseline);
  speed_ = (change(first.seen, last.seen) / span).cwiseAbs().cwiseMax(expected.cwiseAbs());
  speed_[0] = speed_[1] = speed_.head<2>().norm();
}

void StampScatter::compare(const Features& variance) {
  const Image& before = images_[images_.size() - 3];
  const Image& middle = images_[images_.size() - 2];
  const Image& after = images_.back();
  const double share = (middle.time - before.time) / (after.time - before.time);
  const double factor = 1.0 + share * share + (1.0 - share) * (1.0 - share);
  Features squares = speed_.cwiseAbs2().cwiseQuotient(variance);
  squares[1] = 0.0;  // x has both
  const double motion = squares.sum();
  std::vector<double> beside;
  for (std::size_t k = 0; k < after.left.size(); ++k) {
    const Features off = change(before.left[k], middle.left[k]) - share * change(before.left[k], after.left[k]);
    beside.push_back(off.cwiseAbs2().cwiseQuotient(variance).sum() / factor);
  }
  const double most = kFurthest * kFurthest * motion;
  if (beside.empty() || !(*std::min_element(beside.begin(), beside.end()) < most)) return;
  const double weight = motion / (motion + 1.0 / (kResolved * kResolved));
  moved_ += weight;
  for (std::size_t k = 0; k < beside.size(); ++k) {
    const double excess = std::min(beside[k], most) - 4.0 * kNoise;
    square_[k] = std::max(0.0, square_[k] + weight * excess / motion);
  }
}

}  // namespace laparoscope_servo::servo
