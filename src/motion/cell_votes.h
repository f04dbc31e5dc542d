// The motion on which most cells of ESM's sums agree: each cell votes for the shift that solves its own normal
// equations. The result is right even if nearly half of the cells move otherwise; a fit to all pixels would end between
// the two motions.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "laparoscope_servo/motion/motion_config.h"
#include "tracking/esm/esm_level.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::motion {

// A cell's normal equations for a shift of it alone, light apart: matrix * shift = vector, the shift in px of the
// level.
struct CellShift {
  Eigen::Matrix2d matrix;
  Eigen::Vector2d vector;
};
CellShift shiftOf(const tracking::CellSums& cell);

class CellVotes {
 public:
  // The remaining motion, as a field in px of the image about its centre; empty when too few cells can vote. `cells`:
  // the sums of the level, without robust weights. `sigma`: grey levels, standard deviation of residuals where the
  // images are aligned. Deterministic. Does not allocate for a further image of the same size.
  std::optional<geometry::Vector8d> fit(const tracking::EsmLevel& level, const std::vector<tracking::CellSums>& cells,
                                        double sigma, Model model);

 private:
  struct Vote {
    Eigen::Matrix<double, 2, 8> jacobian;
    Eigen::Vector2d shift;  // px of the image
  };
  void gather(const tracking::EsmLevel& level, const std::vector<tracking::CellSums>& cells, double sigma);
  double agreement(const geometry::Vector8d& a, double tolerance) const;
  std::optional<geometry::Vector8d> drawn(int unknowns, double tolerance) const;
  bool refine(geometry::Vector8d& a, int unknowns, double tolerance) const;

  std::vector<Vote> votes_;
};

}  // namespace laparoscope_servo::motion
