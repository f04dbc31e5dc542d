// Bounds how far the scope follows a region from where it was brought to it.
//
// A picture that runs through evenly, a zoom, a camera head that is turned: each looks like tissue that slides, comes
// nearer, or turns, and the loop follows it. Tissue does not go far, hardly turns about the optical axis, and does not
// change its distance quickly by much. So the place of the scope from which the region is seen as it has to be, the
// target, is compared with where it was first. It is known by the scope's pose and by the displacement to the target,
// also before the scope has gone there; tissue at rest leaves it where it is, whatever the scope does. While the scope
// is on its way, wrong depths shift the target, by up to what is left to go: so it is taken anew each time that half of
// the way is done, and the leash is as long as that, along the shaft longer by that.
//
// Another region, another desired view, or restart() take it anew, too.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/leash_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

struct LeashObservation {
  double time = 0.0;             // s, of the exposure
  std::optional<double> region;  // identifies the region of interest
  TaskError error;
  // Displacements (pan, tilt, spin [rad], insertion [m]), see scope_displacement.h: from the scope in the image to the
  // target, and to the scope's pose, which is of another time.
  Eigen::Vector4d to_target = Eigen::Vector4d::Zero();
  Eigen::Vector4d to_pose = Eigen::Vector4d::Zero();
  bool has_orientation = true;  // false: the scope follows none about its shaft, and the target has none
  double d2 = 0.0;              // m, of the pose
  std::optional<Eigen::Isometry3d>
      insertion_point_T_tip;  // with the shaft's axes; empty: only the insertion is bounded
};

class Leash {
 public:
  // The configuration must be valid.
  explicit Leash(const LeashConfig& config) : config_(config) {}

  // Takes an image. One that is not newer than the last, or with values that are not finite, changes nothing.
  void observe(const LeashObservation& image);

  // The next image is where the leash begins.
  void restart();

  // Which way the target has wandered too far, in a text that does not change meanwhile; empty: it has not. It may come
  // back.
  const std::string& words() const { return words_; }

  // Used share of the leash in the last image; above 1 it is too short.
  double used() const { return used_; }

 private:
  struct Target {
    std::optional<Eigen::Matrix3d> insertion_point_R_shaft;
    double d2 = 0.0;  // m
  };
  // Shares of the configured leash: turn, spin, insertion, quick insertion.
  using Shares = Eigen::Vector4d;

  bool isOther(const LeashObservation& image) const;
  Shares shares(const Eigen::Vector3d& turn, double insertion, double quick) const;
  void begin(const LeashObservation& image, const Target& target, const Shares& to_go);

  LeashConfig config_;
  std::optional<LeashObservation> last_;
  Target anchor_;
  Shares to_go_ = Shares::Zero();  // left to go at the anchor
  double mean_d2_ = 0.0;           // m, of the target, over the last quick_time
  double used_ = 0.0;
  std::string words_;
};

}  // namespace laparoscope_servo::servo
