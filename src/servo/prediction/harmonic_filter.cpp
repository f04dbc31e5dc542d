#include "servo/prediction/harmonic_filter.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::servo {

namespace {

// s, over which samples are averaged for the search: the third harmonic of the fastest breath, 1.5 Hz, keeps 86 % of
// its amplitude, sinc(pi 1.5 0.2).
constexpr double kBin = 0.2;
constexpr double kSearchPeriod = 1.0;  // s
constexpr double kMaxAhead = 1.0;      // s: an image age of 0.25 s and a delay of 0.4 s, with a margin of about half
constexpr double kMaxUnexplained = 0.5;
constexpr double kShorter = 0.6;   // factor on the length of a window in which the search failed
constexpr double kShortest = 4.0;  // s
constexpr double kPeriods = 1.7;   // periods in the window that a search needs
constexpr double kSeededPeriods = 1.0;
constexpr double kLongMemory = 4.0;  // s, or one period if longer
constexpr double kSmallPart = 0.3;
constexpr double kShortMemory = 1.0;  // s
constexpr double kUsual = 0.42;       // s of samples, ten at 25 Hz, before the usual innovation is known

HarmonicFilterConfig checked(const HarmonicFilterConfig& config, int channels) {
  std::vector<std::string> errors = validate(config);
  if (channels < 1 || channels > kMaxChannels) {
    errors.push_back("channels = " + std::to_string(channels) + ", expected 1 to 4");
  }
  validation::throwErrors("harmonic filter", errors);
  return config;
}

}  // namespace

double HarmonicFilter::Errors::ratio() const {
  return without() > 0.0 ? with / without() : 1.0;
}

HarmonicFilter::HarmonicFilter(const HarmonicFilterConfig& config, int channels)
    : config_(checked(config, channels)), channels_(channels), kalman_(config.harmonics) {
  reset();
}

void HarmonicFilter::seed(double frequency, double stddev) {
  if (!(frequency >= config_.min_frequency && frequency <= config_.max_frequency) || !(stddev >= 0.0) ||
      !std::isfinite(stddev)) {
    std::ostringstream text;
    text << "harmonic filter: seed " << frequency << " Hz with standard deviation " << stddev << " Hz, expected "
         << config_.min_frequency << " to " << config_.max_frequency << " Hz and at least 0";
    throw std::invalid_argument(text.str());
  }
  seed_ = frequency;
  seed_stddev_ = stddev;
  locked_ = running_ = false;
  startSearching();
}

void HarmonicFilter::unseed() {
  seed_.reset();
  locked_ = running_ = false;
  startSearching();
}

void HarmonicFilter::reset() {
  history_.clear();
  snapshots_.clear();
  shift_ = Channels::Zero(channels_);
  usual_ = 0.0;
  locked_ = running_ = false;
  startSearching();
}

void HarmonicFilter::startSearching() {
  share_ = 0.0;
  searched_ = false;
  seed_counts_ = true;
}

bool HarmonicFilter::update(double time, const Eigen::VectorXd& z, double stddev) {
  if (z.size() != channels_ || !z.allFinite() || !std::isfinite(time)) return false;
  if (!(stddev > 0.0) || !std::isfinite(stddev)) return false;
  if (!history_.empty()) {
    const double dt = time - history_.back().time;
    if (dt == 0.0) return false;
    if (dt < 0.0 || dt > config_.max_gap) reset();
  }
  if (history_.empty()) next_search_ = time + kSearchPeriod;
  Sample sample;
  sample.time = time;
  sample.stddev = stddev;
  sample.z = withoutJumps(time, z, stddev, sample.jumped);
  history_.push_back(sample);
  while (history_.front().time < time - config_.window) history_.pop_front();
  if (running_) {
    step(history_.size() - 1);
    judge(stddev);
  }
  if (!locked_ && time >= next_search_) {
    next_search_ = time + kSearchPeriod;
    // A seed that did not lock may be wrong: every other search ignores it.
    if (searched_) seed_counts_ = !seed_counts_;
    searched_ = true;
    running_ = false;
    share_ = 1.0;
  }
  // One window per sample, since the controller waits for this call.
  if (!locked_ && share_ > 0.0) search();
  return true;
}

Channels HarmonicFilter::withoutJumps(double time, const Channels& z, double stddev, bool& jumped) {
  Channels level = z - shift_;
  if (history_.empty()) return level;
  const double dt = time - history_.back().time;
  Channels predicted;
  if (locked_) {
    predicted = kalman_.offset(kalman_.state()) + kalman_.periodic(kalman_.state(), dt);
  } else {
    const Line line = lineUntil(history_.size() - 1, 0.2);
    predicted = line.value + dt * line.slope;
  }
  const double error = (level - predicted).norm() / std::sqrt(static_cast<double>(channels_));
  const double usual = std::max(usual_, 2.0 * stddev);
  jumped = time - history_.front().time > kUsual && error > config_.jump * usual;
  if (jumped) {
    shift_ += level - predicted;
    level = predicted;
  }
  // A jump raises the usual innovation by at most the threshold, so that fast motion soon stops counting as jumps.
  const double counted = std::min(error, config_.jump * usual);
  const double share = std::min(1.0, dt / 2.0);
  usual_ = std::sqrt((1.0 - share) * usual_ * usual_ + share * counted * counted);
  return level;
}

HarmonicFilter::Line HarmonicFilter::lineUntil(std::size_t last, double seconds) const {
  const double end = history_[last].time;
  double n = 0.0;
  double t_sum = 0.0;
  double tt = 0.0;
  Channels z_sum = Channels::Zero(channels_);
  Channels tz = z_sum;
  for (std::size_t i = last + 1; i-- > 0;) {
    const double t = history_[i].time - end;
    if (t < -seconds) break;
    n += 1.0;
    t_sum += t;
    tt += t * t;
    z_sum += history_[i].z;
    tz += t * history_[i].z;
  }
  const double spread = tt - t_sum * t_sum / n;
  Line line;
  line.slope = Channels::Zero(channels_);
  if (n > 2.0 && spread > 0.0) line.slope = (tz - t_sum / n * z_sum) / spread;
  line.value = z_sum / n - t_sum / n * line.slope;
  return line;
}

Channels HarmonicFilter::meanUntil(std::size_t last, double seconds) const {
  double n = 0.0;
  Channels sum = Channels::Zero(channels_);
  for (std::size_t i = last + 1; i-- > 0 && history_[i].time >= history_[last].time - seconds;) {
    n += 1.0;
    sum += history_[i].z;
  }
  return sum / n;
}

FrequencyBand HarmonicFilter::band() const {
  FrequencyBand band{config_.min_frequency, config_.max_frequency};
  if (seeded()) {
    band.minimum = std::max(band.minimum, *seed_ - 3.0 * seed_stddev_);
    band.maximum = std::min(band.maximum, *seed_ + 3.0 * seed_stddev_);
  }
  return band;
}

FoundFrequency HarmonicFilter::findIn(double seconds) {
  binned_.clear();
  double n = 0.0;
  double from = 0.0;
  for (const Sample& sample : history_) {
    if (sample.time < history_.back().time - seconds) continue;
    if (n == 0.0 || sample.time - from >= kBin) {
      binned_.push_back({0.0, Channels::Zero(channels_)});
      from = sample.time;
      n = 0.0;
    }
    n += 1.0;
    TimedChannels& bin = binned_.back();
    bin.time += (sample.time - bin.time) / n;
    bin.z += (sample.z - bin.z) / n;
  }
  return findFrequency(binned_, band(), 0.5 * history_.back().stddev, seeded() ? kSeededPeriods : kPeriods);
}

void HarmonicFilter::search() {
  const bool whole = share_ == 1.0;
  const double seconds = share_ * (history_.back().time - history_.front().time);
  // Older samples may be invalid: the breath was held, or the patient moved.
  share_ = kShorter * seconds > kShortest ? kShorter * share_ : 0.0;
  const FoundFrequency found = findIn(seconds);
  if (!(found.found && found.unexplained < (whole ? 1.0 : 0.5) * kMaxUnexplained)) return;
  share_ = 0.0;
  while (history_.front().time < history_.back().time - seconds - kBin) history_.pop_front();
  start(found.frequency);
  for (std::size_t i = 0; i < history_.size(); ++i) step(i);
  judge(history_.back().stddev);
}

void HarmonicFilter::start(double frequency) {
  running_ = true;
  locked_ = false;
  snapshots_.clear();
  long_ = short_ = Errors();
  scored_ = 0.0;
  started_ = history_.front().time;
  Channels mean = meanUntil(history_.size() - 1, config_.window);
  double squares = 0.0;
  for (const Sample& sample : history_) squares += (sample.z - mean).squaredNorm();
  const double amplitude = std::sqrt(2.0 * squares / static_cast<double>(history_.size()) / channels_);
  const double length = history_.back().time - history_.front().time;
  kalman_.start(started_, history_.front().z, frequency, seeded() ? seed_stddev_ : 0.05 / length, amplitude);
}

void HarmonicFilter::step(std::size_t index) {
  const Sample& sample = history_[index];
  const double dt = sample.time - kalman_.time();
  HarmonicKalman::Walks walks;
  walks.frequency = config_.frequency_walk * kalman_.frequency();
  walks.offset = config_.offset_walk * sample.stddev;
  walks.harmonics = config_.variation;
  kalman_.predictTo(sample.time, walks);
  if (sample.jumped) kalman_.loosenOffset(5.0 * sample.stddev);
  if (sample.time - started_ > 1.0 / kalman_.frequency()) score(sample, dt);
  const double margin = seeded() ? seed_stddev_ : 0.0;
  const FrequencyBand bounds = band();
  kalman_.correct(sample.z, sample.stddev, bounds.minimum - margin, bounds.maximum + margin);
  snapshots_.push_back({sample.time, kalman_.state(), meanUntil(index, 0.12), lineUntil(index, 0.5)});
}

void HarmonicFilter::score(const Sample& sample, double dt) {
  while (snapshots_.size() > 1 && snapshots_[1].time <= sample.time - config_.horizon) snapshots_.pop_front();
  if (snapshots_.empty() || snapshots_.front().time > sample.time - config_.horizon) return;
  const Snapshot& then = snapshots_.front();
  const double ahead = sample.time - then.time;
  const Channels with = kalman_.offset(then.state) + kalman_.periodic(then.state, ahead);
  Errors errors;
  errors.with = (sample.z - with).squaredNorm();
  errors.mean = (sample.z - then.mean).squaredNorm();
  errors.line = (sample.z - then.line.value - ahead * then.line.slope).squaredNorm();
  const auto forget = [&](Errors& sums, double memory) {
    const double keep = std::exp(-dt / memory);
    sums.with = keep * sums.with + dt * errors.with;
    sums.mean = keep * sums.mean + dt * errors.mean;
    sums.line = keep * sums.line + dt * errors.line;
  };
  forget(long_, longMemory());
  forget(short_, kShortMemory);
  scored_ += dt;
}

double HarmonicFilter::longMemory() const {
  return std::max(kLongMemory, 1.0 / kalman_.frequency());
}

void HarmonicFilter::judge(double stddev) {
  // An error within the noise is no reason to unlock, nor is one that is small against the usual error without a
  // periodic part: between breaths hardly anything moves, and a prediction without a period is then good.
  const double usual = long_.without() / longMemory() * kShortMemory;
  const double floor = 4.0 * channels_ * stddev * stddev + kSmallPart * usual;
  const bool worse_than_none = short_.with > 2.0 * short_.without() + floor;
  if (locked_) {
    if (long_.ratio() < config_.unlock_ratio && !worse_than_none) return;
    locked_ = running_ = false;
    // Motion before the jump is not comparable with that after it.
    while (history_.front().time < history_.back().time - kShortMemory) history_.pop_front();
    return;
  }
  // A random walk can look periodic for a shorter time.
  const double enough = std::max(3.0, 1.0 / kalman_.frequency());
  locked_ = scored_ >= enough && long_.ratio() < config_.lock_ratio && !worse_than_none;
}

PeriodicMotion HarmonicFilter::predict(double time) const {
  PeriodicMotion motion{Eigen::VectorXd::Zero(channels_), Eigen::VectorXd::Zero(channels_)};
  if (!locked_) return motion;
  const double ahead = time - kalman_.time();
  if (!(std::abs(ahead) <= kMaxAhead)) return motion;
  motion.position = kalman_.periodic(kalman_.state(), ahead);
  motion.velocity = kalman_.periodicVelocity(kalman_.state(), ahead);
  return motion;
}

}  // namespace laparoscope_servo::servo
