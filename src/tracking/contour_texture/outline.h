// A closed contour of the reference image, which a homography moves: its sites for the edge stage.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/spline.h"

namespace laparoscope_servo::tracking {

class Outline {
 public:
  static constexpr int kSlots = 400;

  Outline() = default;
  // `contour`: px of the reference image. `normalisation`: N of Esm, from pixels to template coordinates.
  Outline(const features::Spline& contour, const Eigen::Matrix3d& normalisation);

  // Where `g` takes it, about `spacing` px apart, `most` at most. The jacobian of a site is the derivative of its
  // displacement along its normal, px, by the step x of G in Sl3Steps; first is 0, count 8. Overwrites `result`.
  void sites(const Eigen::Matrix3d& g, double spacing, int most, std::vector<features::Site>& result) const;

  // The point of a slot, px of the reference image.
  const Eigen::Vector2d& point(int slot) const { return places_[static_cast<std::size_t>(slot)].point; }
  double length() const { return length_; }  // px, in the reference image

 private:
  struct Place {
    Eigen::Vector2d point;
    Eigen::Vector2d tangent;
    Eigen::Matrix<double, 2, 8> step;  // px, of the point by x at G = I
  };

  features::Site site(const Eigen::Matrix3d& g, int slot) const;

  std::vector<Place> places_;  // one for each slot
  double length_ = 0.0;
};

}  // namespace laparoscope_servo::tracking
