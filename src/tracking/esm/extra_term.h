// What is known of ESM's unknowns besides the residuals, and is minimised together with them.
#pragma once

#include <Eigen/Core>

#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

class ExtraTerm {
 public:
  virtual ~ExtraTerm() = default;

  // At `g`, pixels of the reference to those of the image, and this gain: adds J'WJ and J'We of errors e whose
  // derivative by the unknowns (in NormalEquations' order) is J, both over the errors' variance.
  virtual void add(const Eigen::Matrix3d& g, double gain, Matrix10d& information, Vector10d& score) = 0;
};

}  // namespace laparoscope_servo::tracking
