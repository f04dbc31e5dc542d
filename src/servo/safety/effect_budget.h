// Limits how far the scope may move before the images have confirmed the effect of its motion.
//
// Each fault hypothesis of the effect guard is open until the images exclude it: until the log-likelihood of the
// correct picture exceeds that of the fault by a threshold. While a fault is open, motion that would have a wrong
// effect under it uses up a budget: pan and tilt under a roll, insertion under a reversed insertion. Motion that the
// fault does not affect uses none, and does not reveal the fault either. The commanded motion counts, from the place
// where the fault was opened, so that the limit also holds if images are interrupted or the robot does something else.
// An excluded fault is opened again after a while, and at once if the sequence of images is interrupted, since they may
// then come from another camera.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "laparoscope_servo/servo/effect_config.h"

namespace laparoscope_servo::servo {

struct EffectExplanation;

class EffectBudget {
 public:
  // The configuration must be valid.
  explicit EffectBudget(const EffectConfig& config);
  ~EffectBudget();
  EffectBudget(EffectBudget&&) noexcept;
  EffectBudget& operator=(EffectBudget&&) noexcept;

  // Call when engaging: all faults are open, and nothing is spent.
  void restart();

  // Call when the sequence of images is interrupted: all faults are open. The motion spent stays spent.
  void interrupt();

  // Takes a commanded displacement (pan, tilt, spin [rad], insertion [m]). `for_view`: false if a person commands it,
  // who sees the effect.
  void command(const Eigen::Vector4d& displacement, bool for_view);

  // Takes an image, `dt` [s] after the last: its log-likelihoods under each of effectExplanations(), the commanded
  // motion not executed yet, and the camera's angle about the shaft [rad]. `breath_known`: the image cannot be
  // distinguished from a frozen one.
  void see(double dt, const std::vector<double>& log_likelihoods, const Eigen::Vector4d& pending, double turned,
           bool breath_known);

  // Used share of the budget; 1: used up; NaN after a displacement that was not finite.
  double spent() const;

  // Used share for spin and insertion: their motion while a fault of pan and tilt was open, which they do not reveal.
  double aside() const;

 private:
  struct Fault;

  EffectConfig config_;
  std::vector<Fault> faults_;
  std::vector<double> good_;                         // log-likelihoods
  Eigen::Vector4d moved_ = Eigen::Vector4d::Zero();  // sum of the commanded displacements
  Eigen::Vector4d done_ = Eigen::Vector4d::Zero();   // part of moved_ that was executed by the last image
  double turned_ = 0.0;                              // rad
};

}  // namespace laparoscope_servo::servo
