// The law of Bourger et al. (2007).
#pragma once

#include "laparoscope_servo/servo/law_config.h"
#include "servo/law/control_law.h"

namespace laparoscope_servo::servo {

// Bourger et al. (2007), eq. (7) and (11). On the optical axis, before a plane across it at Z*, the errors decay with
// k_p (1 + d2/Z*), k_t (1 + d2/Z*), 2 k_s and k_d / Z*: an error of d2 or Z* changes the rate only. With oblique optics
// the wanted twist is turned into the shaft's axes first.
class PaperLaw : public ControlLaw {
 public:
  explicit PaperLaw(const PaperGains& gains) : gains_(gains) {}
  LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const override;

 private:
  PaperGains gains_;
};

}  // namespace laparoscope_servo::servo
