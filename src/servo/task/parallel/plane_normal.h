// The normal of the plane of tissue in the arm's base, from the motion of its image and the arm's own motion.
//
// A view of the plane n'X = d is its homography since the anchor image, H = R + T n' with T = t / d: the motion that
// eq. (8) of Marchand and Chaumette (2004) is the velocity of, for g1 = -n1 / n3, g2 = -n2 / n3, Zp = d / n3. R is
// known from the arm's poses, but for the anchor's own pose and a factor on the arm's turns. All views together
// determine the normal; each has a T of its own, so that tissue that breathes or slides does not disturb it, as long as
// it does not tilt. Gauss-Newton on all views, with Tukey's weights for views that do not fit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "laparoscope_servo/servo/view_motion.h"

namespace laparoscope_servo::servo {

struct PlaneView {
  ViewMotion motion;
  Eigen::Matrix3d base_R_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();  // m, its centre in the base
};

struct PlaneEstimate {
  bool is_known = false;                             // false: the views do not determine the rest
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector in the base, from the camera into the tissue
  double stddev = 0.0;                               // rad, of the normal, in the direction in which it is largest
  double distance = 0.0;                             // m, from the base's origin along the normal to the plane
  double agreement = 0.0;    // 0 to 1: share of the camera's way, as the picture shows it, that is the arm's
  double turn_factor = 1.0;  // of the camera's turns over those of the arm's poses
  double misfit = 0.0;       // root mean square of what is left over, in standard deviations of the noise
  Eigen::Matrix3d base_R_first = Eigen::Matrix3d::Identity();  // of the first view's pose, from which turns count
  Eigen::Vector3d normal_in_anchor = Eigen::Vector3d::Zero();  // in the frame of the anchor's camera

  // A camera's rotation in the base, with the factor taken into account.
  Eigen::Matrix3d corrected(const Eigen::Matrix3d& base_R_camera) const;
  // The normal in that camera's frame.
  Eigen::Vector3d seenFrom(const Eigen::Matrix3d& base_R_camera) const {
    return corrected(base_R_camera).transpose() * normal;
  }
  // Where the optical axis points by the arm's poses, with their factor on turns, once it is on the normal.
  Eigen::Vector3d normalOfPoses() const;
};

class PlaneNormal {
 public:
  static constexpr std::size_t kMostViews = 256;

  PlaneNormal();

  void restart();
  // Takes a view of the same anchor; one with values that are not finite, or beyond kMostViews, changes nothing.
  void add(const PlaneView& view);
  std::size_t views() const { return views_.size(); }
  const PlaneEstimate& estimate() const { return estimate_; }

 private:
  static constexpr int kShared = 6;  // normal (2), the anchor's rotation (3), factor on the turns
  using Shared = Eigen::Matrix<double, kShared, 1>;
  using Information = Eigen::Matrix<double, kShared, kShared>;
  using Basis = Eigen::Matrix<double, 3, 2>;

  struct Seen {
    std::array<Eigen::Vector2d, 4> corners;  // normalised, in this image
    double noise = 0.0;
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rad, of the arm since the first view
    Eigen::Vector3d camera = Eigen::Vector3d::Zero();
    Eigen::Vector3d step = Eigen::Vector3d::Zero();  // T
    double misfit = 0.0;                             // squares of what is left over, in variances of the noise
    double weight = 1.0;
  };

  void begin(const PlaneView& view);
  void fitStep(Seen& seen) const;
  void weigh();
  bool improve();
  void tell();

  std::vector<Seen> views_;
  std::vector<double> scratch_;
  std::array<Eigen::Vector3d, 4> anchor_;  // the points of the anchor that the first view shows in its corners
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();  // in the anchor's camera
  Eigen::Matrix3d first_R_anchor_ = Eigen::Matrix3d::Identity();
  double turn_error_ = 0.0;
  double scale_ = 1.0;  // robust, of the misfit of a view
  Information information_ = Information::Zero();
  PlaneEstimate estimate_;
};

}  // namespace laparoscope_servo::servo
