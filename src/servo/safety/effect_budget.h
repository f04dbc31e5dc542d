// How far the scope may go before the picture has shown what its motion does.
//
// Each fault that the guard of effect knows is open until the images speak against it: until the log-likelihood of the
// picture as it should be is above that of the fault by `confirmed`. While a fault is open, motion whose effect would
// be wrong under it counts against a budget: pan and tilt under a roll, insertion under a reversed insertion. Motion
// that the fault would leave as it is does not, nor would it show the fault. It is the motion that was commanded that
// counts, from where the scope was when the fault was opened: whatever interrupts the images, or lets the robot do
// something else, the scope goes no further. A fault that was spoken against is opened again after a while, and at once
// where the images do not go on from one to the next: another camera's may have taken their place.
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

  // Somebody has engaged: every fault is open, nothing is spent.
  void restart();

  // The images do not go on: every fault is open. What is spent stays spent.
  void interrupt();

  // The scope was told to go by (pan, tilt, spin [rad], insertion [m]); not `for_view`: by somebody, who sees it.
  void command(const Eigen::Vector4d& displacement, bool for_view);

  // An image, `dt` [s] after the last: log-likelihoods by each of effectExplanations(), what the scope was told and had
  // not done yet, and which way the camera is turned about the shaft [rad]. `breath_known`: a frozen picture cannot be
  // told from this one.
  void see(double dt, const std::vector<double>& log_likelihoods, const Eigen::Vector4d& pending, double turned,
           bool breath_known);

  // Share of the budget, 1: it is used up.
  double spent() const;

  // Of spin and insertion, by as much as they have gone while a fault of pan and tilt was open, which they do not show.
  double aside() const;

 private:
  struct Fault;

  EffectConfig config_;
  std::vector<Fault> faults_;
  std::vector<double> good_;                         // log-likelihoods
  Eigen::Vector4d moved_ = Eigen::Vector4d::Zero();  // by commands
  Eigen::Vector4d done_ = Eigen::Vector4d::Zero();   // of this, at the last image
  double turned_ = 0.0;                              // rad
};

}  // namespace laparoscope_servo::servo
