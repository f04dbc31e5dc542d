#include "servo/safety/effect_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "servo/safety/effect_explanations.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {

namespace {

// s without an image, after which nothing is compared: tissue may have gone by 12 px on its own by then (tissue_centre
// of 0.06 a second, at a focal length of 400 px), more than the scope moves the picture while it is not confirmed.
constexpr double kGap = 0.5;
// s without an image, after which this may be another picture though the place fits: within a pause the tissue may have
// gone as far as a mirrored picture puts it. Images that are lost in between are not meant.
constexpr double kPause = 0.25;
constexpr double kSpan = 3.0;  // s of reports that are kept: more than kGap, kPatience and the latest explanation
constexpr double kReportLife = 0.25;  // s for which a report stands for the motion: one of a robot at 10 Hz may be lost
constexpr double kReports = 0.3;  // s without a report after which the robot is one that says nothing: three at 10 Hz
constexpr double kSameOptics = 0.05;  // rad, by which the camera may be turned about the shaft: a tenth of a roll step
constexpr double kPatience = 0.3;     // s that an image waits for a report of its time: as long as one is expected
// px, the corner error of a good image (simulate_servo's corner_noise): the noise of one that is worse grows with it.
constexpr double kCornerError = 0.3;
// Times that noise: the tracker believes in nothing beyond 1.5 px, and no corner error may blind the guard.
constexpr double kWorst = 5.0;
// Of an innovation's square over its variance: more is no further evidence. Measured with
// simulate_servo, 20 starts each of effect_{spin_reversed,insertion_reversed,rolled_90,mirrored}: 9 misses one start in
// which the insertion is reversed and lets the others turn by up to 18 % more in the median; 25 is as 16.
constexpr double kBound = 16.0;
constexpr double kJump = 100.0;  // the same: where no explanation is nearer, the tracker slipped or the tissue was torn
// And here another picture may have taken the place: tissue that is pulled by 20 mm in half a second stays below.
constexpr double kOther = 400.0;
// Standard deviations of what stamps make: evenly spread ones are never further from each other.
constexpr double kScattered = 3.5;
// Log of how much less likely it is that a fault begins in an image than that there is none. Chosen, not varied since.
// Lower: more false alarms; higher: later detection of faults that begin later.
constexpr double kOnset = 3.0;
// Where the best fault is less likely than none by all but this much of kOnset, it explains nothing: confirmed.
constexpr double kConfirmed = 0.5;
// Smallest ratio of the picture's motion to that predicted from the depths for which a hypothesis counts as correct in
// judge(): below it, wrong depths cannot be distinguished from a frozen picture. The budget accepts also the smaller
// ones.
constexpr double kLeastReach = 0.5;

}  // namespace

struct EffectGuard::Track {
  EffectExplanation explanation;
  Features moved = Features::Zero();     // by the scope
  Features place = Features::Zero();     // of the tissue, if the scope had not moved
  Features velocity = Features::Zero();  // 1/s
  double log_likelihood = 0.0;

  // The features in the picture as it should be.
  Features seen(const TaskError& error) const {
    const Eigen::Vector2d centre = explanation.picture.transpose() * Eigen::Vector2d(error.x, error.y);
    return {centre.x(), centre.y(), error.log_depth, explanation.picture.determinant() * error.alpha};
  }
};

EffectGuard::EffectGuard(const EffectConfig& config, const Eigen::Vector3d& noise)
    : config_(config),
      budget_(config),
      reports_(kSpan, kReportLife),
      last_report_(-std::numeric_limits<double>::infinity()) {
  noise_ = Features(noise[0], noise[0], noise[1], noise[2]).cwiseAbs2();
  tissue_ << config.tissue_centre, config.tissue_centre, config.tissue_depth, config.tissue_orientation;
  for (const EffectExplanation& explanation : effectExplanations()) {
    tracks_.emplace_back();
    tracks_.back().explanation = explanation;
  }
}

EffectGuard::~EffectGuard() = default;
EffectGuard::EffectGuard(EffectGuard&&) noexcept = default;
EffectGuard& EffectGuard::operator=(EffectGuard&&) noexcept = default;

void EffectGuard::rearm() {
  effect_ = Effect::kAsCommanded;
  words_.clear();
  confirmed_ = doubted_before_ = false;
  budget_.restart();
  forget();
}

void EffectGuard::anotherTracker() {
  started_ = false;
  waiting_.clear();
}

void EffectGuard::forget() {
  evidence_ = 0.0;
  for (Track& track : tracks_) track.log_likelihood = 0.0;
}

void EffectGuard::report(double time, const scope::Velocity& velocity) {
  if (!velocity.vector().allFinite() || !std::isfinite(time)) return;
  reports_.add(time, velocity);
  last_report_ = time;
}

// (pan, tilt, spin [rad], insertion [m]) since the last image.
Eigen::Vector4d EffectGuard::executed(double end, double late, const CommandHistory& commands, double delay) const {
  if (reports(end)) return reports_.displacement(last_.time - late, end - late);
  return commands.displacement(last_.time, end, delay + late);
}

// How far the features move by a displacement of the scope.
EffectGuard::Features EffectGuard::predicted(const EffectExplanation& explanation,
                                             const Eigen::Vector4d& displacement) const {
  const Eigen::Vector2d centre = explanation.picture.transpose() * Eigen::Vector2d(last_.error.x, last_.error.y);
  TaskError before = last_.error;
  before.x = centre.x();
  before.y = centre.y();
  before.alpha *= explanation.picture.determinant();
  const TaskError after = moved(before, explanation.arm.cwiseProduct(displacement), last_.scope, last_.desired_depth);
  const Features change(after.x - before.x, after.y - before.y, after.log_depth - before.log_depth,
                        std::remainder(after.alpha - before.alpha, 2.0 * M_PI));
  return explanation.reach * change;
}

void EffectGuard::start(const EffectObservation& image, bool other) {
  started_ = true;
  last_ = image;
  if (other) budget_.interrupt();
  for (Track& track : tracks_) {
    if (!track.moved.allFinite()) track.moved.setZero();
    track.velocity.setZero();
    track.place = track.seen(image.error) - track.moved;
  }
  for (int k = 0; k < 4; ++k) covariance_[k] = Eigen::Vector2d(noise_[k], tissue_[k] * tissue_[k]).asDiagonal();
}

// Ornstein-Uhlenbeck: a velocity is forgotten, and a new one of the same spread takes its place.
void EffectGuard::advance(double dt) {
  const double tau = config_.tissue_time;
  const double kept = std::exp(-dt / tau);
  Eigen::Matrix2d transition;
  transition << 1.0, tau * (1.0 - kept), 0.0, kept;
  Eigen::Matrix2d added;
  added(0, 0) = tau * (2.0 * dt - tau * (3.0 - 4.0 * kept + kept * kept));
  added(0, 1) = added(1, 0) = tau * (1.0 - kept) * (1.0 - kept);
  added(1, 1) = 1.0 - kept * kept;
  for (int k = 0; k < 4; ++k) {
    covariance_[k] = transition * covariance_[k] * transition.transpose() + tissue_[k] * tissue_[k] * added;
  }
  for (Track& track : tracks_) {
    track.place += tau * (1.0 - kept) * track.velocity;
    track.velocity *= kept;
    track.log_likelihood *= std::exp(-dt / config_.memory);
  }
}

Effect EffectGuard::observe(const EffectObservation& image, const CommandHistory& commands, double delay) {
  if (!config_.enabled || !isFinite(image.error)) return effect_;
  const double newest = waiting_.empty() ? last_.time : waiting_.back().time;
  if (!(started_ || !waiting_.empty()) || image.time != newest) waiting_.push_back(image);
  while (!waiting_.empty()) {
    const EffectObservation first = waiting_.front();
    // Back in time, or still without a report: what the robot did until then is not known.
    const bool in_vain = !(image.time - first.time >= 0.0 && image.time - first.time < kPatience);
    if (!in_vain && reports(first.time) && last_report_ < first.time) break;
    waiting_.pop_front();
    if (in_vain) {
      scatter_.restart();
      start(first, isOther(first));
    } else {
      judge(first, commands, delay);
    }
  }
  return effect_;
}

// The robot is one that says what it does.
bool EffectGuard::reports(double time) const {
  return time - last_report_ <= kReports;
}

// It does not go on from the last one.
bool EffectGuard::isOther(const EffectObservation& image) const {
  const double dt = image.time - last_.time;
  const bool other_region = image.error.m_star != last_.error.m_star || image.region != last_.region;
  const bool other_optics = !image.scope.camera_R_shaft.isApprox(last_.scope.camera_R_shaft, kSameOptics);
  return !started_ || !(dt > 0.0 && dt <= kGap) || other_region || other_optics;
}

// The same tissue and the same motion, seen at another place: each explanation keeps its likelihood.
void EffectGuard::changeRegion(const EffectObservation& image) {
  for (Track& track : tracks_) {
    track.place += track.seen(image.error) - track.seen(*image.in_last_region);
  }
  last_ = image;
}

void EffectGuard::judge(const EffectObservation& image, const CommandHistory& commands, double delay) {
  if (image.in_last_region) {
    EffectObservation before = image;
    before.in_last_region.reset();
    before.region = last_.region;
    before.error = *image.in_last_region;
    judge(before, commands, delay);
    changeRegion(image);
    return;
  }
  const double dt = image.time - last_.time;
  if (isOther(image)) {
    scatter_.restart();
    start(image, true);
    return;
  }
  if (dt > kPause) budget_.interrupt();
  // Those that come equally late stand beside each other.
  double late = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector4d displacement;
  Features fastest = Features::Zero();
  for (Track& track : tracks_) {
    if (track.explanation.late != late) displacement = executed(image.time, track.explanation.late, commands, delay);
    late = track.explanation.late;
    const Features step = predicted(track.explanation, displacement);
    track.moved += step;
    if (track.explanation.reach == 1.0) fastest = fastest.cwiseMax(step.cwiseAbs());
  }
  advance(dt);
  double quality = kWorst;  // also where the corner error is NaN
  if (image.corner_error < kWorst * kCornerError) quality = std::max(1.0, image.corner_error / kCornerError);
  const Features noise = quality * quality * noise_;
  measureScatter(image, noise, fastest / dt);
  const double off = compare(image, noise, commands.displacement(image.time, image.time + kSpan, delay));
  if (!(off < kJump)) {
    start(image, !(off < kOther));
    return;
  }
  last_ = image;
  judge();
}

void EffectGuard::measureScatter(const EffectObservation& image, const Features& noise, const Features& expected) {
  std::vector<Features> left;
  for (const Track& track : tracks_) left.push_back(track.seen(image.error) - track.moved);
  const Features seen(image.error.x, image.error.y, image.error.log_depth, image.error.alpha);
  scatter_.take(image.time, seen, left, noise, expected);
}

// How far the image is from the nearest of what was expected, square over variance.
double EffectGuard::compare(const EffectObservation& image, const Features& noise, const Eigen::Vector4d& pending) {
  const Features scattered = scatter_.seconds() * scatter_.speed();
  const Features measured = std::max(0.0, scatter_.seconds() - StampScatter::kBefore) * scatter_.speed();
  Features quiet, variance, place_gain, velocity_gain;
  for (int k = 0; k < 4; ++k) {
    quiet[k] = covariance_[k](0, 0) + noise[k];
    variance[k] = quiet[k] + scattered[k] * scattered[k];
    const Eigen::Vector2d gain = covariance_[k].col(0) / variance[k];
    place_gain[k] = gain[0];
    velocity_gain[k] = gain[1];
    covariance_[k] -= gain * covariance_[k].row(0).eval();
  }
  std::vector<Features> innovations;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Track& track : tracks_) {
    Features innovation = track.seen(image.error) - track.moved - track.place;
    innovation[3] = std::remainder(innovation[3], 2.0 * M_PI);
    // An explanation by which the picture is nowhere would stay without a likelihood, and the best of all with it.
    if (!innovation.allFinite()) return std::numeric_limits<double>::infinity();
    innovations.push_back(innovation);
    // A jump is not to pass for scatter that is only taken for granted.
    const Features beyond = (innovation.cwiseAbs() - kScattered * measured).cwiseMax(0.0);
    nearest = std::min(nearest, beyond.cwiseAbs2().cwiseQuotient(quiet).maxCoeff());
  }
  if (!(nearest < kJump)) return nearest;
  calm(image.time - last_.time, innovations, variance);
  std::vector<double> likelihoods(tracks_.size(), 0.0);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Features squares = innovations[i].cwiseAbs2().cwiseQuotient(variance.cwiseProduct(unrest_));
    for (int k = 0; k < 4; ++k) likelihoods[i] -= 0.5 * squares[k] / (1.0 + squares[k] / kBound);
    tracks_[i].log_likelihood += likelihoods[i];
    tracks_[i].place += place_gain.cwiseProduct(innovations[i]);
    tracks_[i].velocity += velocity_gain.cwiseProduct(innovations[i]);
  }
  const Eigen::Matrix3d& optics = image.scope.camera_R_shaft;
  const double turned = std::atan2(optics(1, 0) - optics(0, 1), optics(0, 0) + optics(1, 1));
  budget_.see(image.time - last_.time, likelihoods, pending, turned, image.breath_known);
  return nearest;
}

// An innovation common to all hypotheses is attributed to unusual motion of the tissue.
void EffectGuard::calm(double dt, const std::vector<Features>& innovations, const Features& variance) {
  Features least = Features::Constant(std::numeric_limits<double>::infinity());
  for (const Features& innovation : innovations) {
    const Features squares = innovation.cwiseAbs2().cwiseQuotient(variance);
    const double centre = 0.5 * (squares[0] + squares[1]);
    least = least.cwiseMin(Features(centre, centre, squares[2], squares[3]));
  }
  unrest_ = (std::exp(-dt / config_.unrest_time) * unrest_).cwiseMax(least).cwiseMax(1.0);
}

// A fault may begin at any time: one that explains nothing of what was is taken to begin now, with the tissue as the
// picture showed it until now.
void EffectGuard::begin(Track& fault, const Track& good) const {
  fault.log_likelihood = good.log_likelihood - kOnset;
  const Eigen::Matrix2d turn = fault.explanation.picture.transpose() * good.explanation.picture;
  const auto turned = [&turn](Features features) {
    features.head<2>() = (turn * features.head<2>()).eval();
    features[3] *= turn.determinant();
    return features;
  };
  fault.velocity = turned(good.velocity);
  const Features noise = good.place + good.moved - good.seen(last_.error);  // of this image
  fault.place = fault.seen(last_.error) + turned(noise) - fault.moved;
}

void EffectGuard::judge() {
  const Track* good = nullptr;
  for (const Track& track : tracks_) {
    const bool is_good = track.explanation.fault.empty() && track.explanation.reach > kLeastReach;
    if (is_good && (good == nullptr || track.log_likelihood > good->log_likelihood)) good = &track;
  }
  const Track* fault = nullptr;
  for (Track& track : tracks_) {
    if (track.explanation.fault.empty()) continue;
    // A breath that is followed as it was learnt does not move in the picture, no more than a frozen one does.
    const bool alike = track.explanation.frozen() && last_.breath_known;
    if (alike || track.log_likelihood < good->log_likelihood - kOnset) begin(track, *good);
    if (fault == nullptr || track.log_likelihood > fault->log_likelihood) fault = &track;
  }
  evidence_ = fault->log_likelihood - good->log_likelihood;
  if (evidence_ <= kConfirmed - kOnset) confirmed_ = true;
  decide(fault->explanation.fault);
}

void EffectGuard::decide(const std::string& fault) {
  const Effect before = effect_;
  if (effect_ == Effect::kAsCommanded && evidence_ >= config_.doubt) {
    // Doubted again, and nothing in between spoke for it.
    effect_ = doubted_before_ && !confirmed_ ? Effect::kWrong : Effect::kDoubted;
    doubted_since_ = last_.time;
    doubted_before_ = true;
    confirmed_ = false;
    budget_.interrupt();
  } else if (effect_ == Effect::kDoubted) {
    const bool stands = last_.time - doubted_since_ >= config_.standing_time;
    if (stands && evidence_ >= config_.certain) effect_ = Effect::kWrong;
    if (evidence_ < config_.release) effect_ = Effect::kAsCommanded;
  }
  if (effect_ == before) return;
  words_ = effect_ == Effect::kAsCommanded ? "" : "the picture moves as if it were " + fault;
}

}  // namespace laparoscope_servo::servo
