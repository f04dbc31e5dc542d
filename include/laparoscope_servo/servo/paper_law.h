// The law of Bourger et al. (2007).
#pragma once

#include "laparoscope_servo/servo/control_law.h"

namespace laparoscope_servo::servo {

// Gains of the paper's experiment, (k_p, k_t, k_s, k_d). For pan and tilt they hold the 1/d2 of eq. (11).
struct PaperGains {
  double pan = 0.3;         // 1/s, k_p
  double tilt = 0.3;        // 1/s, k_t
  double spin = 0.3;        // 1/s, k_s
  double insertion = 0.02;  // m/s, k_d
};

// Bourger et al. (2007), eq. (7) and (11). On the optical axis, before a plane across it at Z*, the errors decay with
// k_p (1 + d2/Z*), k_t (1 + d2/Z*), 2 k_s and k_d / Z*: a wrong d2 or Z* changes how fast, not whether. With oblique
// optics the wanted twist is turned into the shaft's axes first.
class PaperLaw : public ControlLaw {
 public:
  explicit PaperLaw(const PaperGains& gains) : gains_(gains) {}
  LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const override;

 private:
  PaperGains gains_;
};

}  // namespace laparoscope_servo::servo
