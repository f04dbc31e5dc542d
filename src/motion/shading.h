// How much brighter the reference is than the image, from place to place. The lamp of a scope goes along with it: since
// an image of a while ago, slanted tissue has become brighter where it came nearer, and darker elsewhere. With one gain
// for all pixels that would pull the motion. A quadratic polynomial over the image, which motion hardly changes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::motion {

class Shading {
 public:
  Shading();

  // 1 everywhere.
  void forget();
  // By the means of what is warped into the level, without any correction, and of the reference, block by block,
  // robustly. With too few blocks it stays as it is.
  void fit(const tracking::EsmLevel& level);
  // Multiplies what is warped into the level.
  void correct(tracking::EsmLevel& level) const;

  // At a place from -1 to 1 across and down the image.
  double at(double x, double y) const;

 private:
  using Coefficients = Eigen::Matrix<double, 6, 1>;  // of 1, x, y, x^2, xy, y^2

  struct Block {
    double x, y, ratio;
  };

  static Coefficients termsAt(double x, double y);

  Coefficients polynomial_;
  std::vector<Block> blocks_;
  std::vector<double> scratch_;
};

}  // namespace laparoscope_servo::motion
