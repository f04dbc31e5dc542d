// Whether the picture moves as the scope's motion makes it move.
//
// Optics that are rolled against the configuration, a mirrored picture, a wrong sign or shaft frame, a picture that is
// frozen or another camera's: each makes the loop drive the region away, and none shows in a single image. So every
// image is explained in several ways at once: by a picture that is what it should be, and by each of the faults. An
// explanation predicts from the motion of the scope how the region moves in the image; what is left over has to be the
// tissue's own motion. Tissue moves smoothly, no faster than a bound, and does not begin to move whenever the scope
// does: a Kalman filter of place and velocity for each feature, with velocities as of an Ornstein-Uhlenbeck process,
// says how likely the motion is that an explanation leaves to the tissue. The weight of an innovation is bounded, so
// that no single image decides, and a restlessness that no explanation is free of is taken off all of them. Likelihoods
// are forgotten over `memory`. Where a fault explains the last seconds better than the picture as it should be, by the
// log of the ratio of the likelihoods, the motion is doubted and the scope has to stand. What the picture does when it
// stands decides: tissue that happened to be pulled when the scope began to move goes on, a fault stops with the scope.
//
// Tissue that is followed well does not move in the picture, no more than a frozen one does. They differ in which moved
// first, scope or tissue. While a learnt breath is compensated, both cannot be told apart, and a frozen picture is not
// detected.
//
// A picture that is older than its stamp says moves as it should, only later. It takes no budget, since nothing goes
// astray; but the law predicts from the wrong moment, and the loop swings. That is a fault, too, from some 0.22 s on:
// between the 0.14 s by which a good picture may be late, and 0.3 s. Below, the gains are lowered when the loop swings.
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/effect_config.h"
#include "laparoscope_servo/servo/task_function.h"
#include "servo/prediction/command_history.h"
#include "servo/safety/effect.h"
#include "servo/safety/effect_budget.h"
#include "servo/safety/reported_motion.h"
#include "servo/safety/stamp_scatter.h"

namespace laparoscope_servo::servo {

struct EffectExplanation;

struct EffectObservation {
  double time = 0.0;  // s, of the exposure
  TaskError error;
  double region = 0.0;                      // identifies what the error is of
  std::optional<TaskError> in_last_region;  // where that is another one that goes on: the error of the last one
  scope::Geometry scope;                    // as configured
  double desired_depth = 0.0;               // m, Z*
  double corner_error = 0.0;                // px, expected of the worst corner
  bool breath_known = false;                // the scope follows the breath as it was learnt
};

class EffectGuard {
 public:
  // The configuration must be valid. `noise` of a good image: centre (normalised), log depth, orientation [rad].
  EffectGuard(const EffectConfig& config, const Eigen::Vector3d& noise);
  ~EffectGuard();
  EffectGuard(EffectGuard&&) noexcept;
  EffectGuard& operator=(EffectGuard&&) noexcept;

  // What the robot says that it did at `time` [s].
  void report(double time, const scope::Velocity& velocity);

  // Judges an image by what the robot said of its motion until then; where it never says anything, by `commands`, each
  // executed `delay` [s] after it was given. Where it has not yet said what it did until then, the image waits for the
  // next call, for 0.2 s at most; then nothing is concluded from it. An image with the time of the last one changes
  // nothing; one of another region, or after a pause, is only the start of what follows.
  Effect observe(const EffectObservation& image, const CommandHistory& commands, double delay);

  Effect effect() const { return effect_; }
  // What the picture does, from the doubt on; it stays as it was said first.
  const std::string& words() const { return words_; }
  // Log of the ratio of likelihoods: the best fault over the picture as it should be.
  double evidence() const { return evidence_; }
  // Since it was armed, or last doubted, the picture has moved as no fault explains.
  bool confirmed() const { return confirmed_; }
  // How far the scope may go before that is seen.
  const EffectBudget& budget() const { return budget_; }
  // The scope was told to go by (pan, tilt, spin [rad], insertion [m]); `for_view`: by the control law.
  void command(const Eigen::Vector4d& displacement, bool for_view) { budget_.command(displacement, for_view); }

  // Another task begins, which goes by another tracker: its first image is only the start of what follows.
  void anotherTracker();

  // Somebody has engaged: nothing is held against the picture any more; what is known of the tissue's motion stays.
  void rearm();

 private:
  using Features = Eigen::Vector4d;  // x, y, log depth, alpha
  // An explanation, and what the tissue does if it is true.
  struct Track;

  // `other`: this may be another picture.
  void start(const EffectObservation& image, bool other);
  bool isOther(const EffectObservation& image) const;
  bool reports(double time) const;
  void judge(const EffectObservation& image, const CommandHistory& commands, double delay);
  void changeRegion(const EffectObservation& image);
  void advance(double dt);
  Eigen::Vector4d executed(double end, double late, const CommandHistory& commands, double delay) const;
  Features predicted(const EffectExplanation& explanation, const Eigen::Vector4d& displacement) const;
  void measureScatter(const EffectObservation& image, const Features& noise, const Features& expected);
  double compare(const EffectObservation& image, const Features& noise, const Eigen::Vector4d& pending);
  void calm(double dt, const std::vector<Features>& innovations, const Features& variance);
  void begin(Track& fault, const Track& good) const;
  void judge();
  void forget();
  void decide(const std::string& fault);

  EffectConfig config_;
  EffectBudget budget_;
  Features noise_;   // variance
  Features tissue_;  // 1/s, standard deviation of its velocity
  std::vector<Track> tracks_;
  ReportedMotion reports_;
  double last_report_;  // s
  bool started_ = false;
  EffectObservation last_;
  std::deque<EffectObservation> waiting_;
  std::array<Eigen::Matrix2d, 4> covariance_;  // of place and velocity, the same for each explanation
  StampScatter scatter_;
  Features unrest_ = Features::Ones();  // over the variance that is expected
  double evidence_ = 0.0;
  Effect effect_ = Effect::kAsCommanded;
  std::string words_;
  bool confirmed_ = false;
  bool doubted_before_ = false;  // since it was armed
  double doubted_since_ = 0.0;   // s
};

}  // namespace laparoscope_servo::servo
