// What the trackers make of the picture of a plane of tissue: the task error of each task, with the configured faults
// of the picture.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "closed_loop/noise.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "laparoscope_servo/servo/points_error.h"

namespace laparoscope_servo::closed_loop {

class SimulatedPicture {
 public:
  // `camera_R_shaft`: rotation of the optics.
  SimulatedPicture(const SimulationConfig& config, const servo::ControllerConfig& control,
                   const Eigen::Matrix3d& camera_R_shaft);

  // From now on the picture is of this homography, whatever comes.
  void freeze(const Eigen::Matrix3d& h);
  bool isFrozen() const { return frozen_.has_value(); }

  // The homography of the picture, where that of the tissue is `h`: both take normalised points of the reference image
  // to the current one.
  Eigen::Matrix3d seen(const Eigen::Matrix3d& h) const;

  // What `task` gets at `time` [s]. `h`: the tissue's homography, `d2` [m] as the controller believes it.
  servo::TaskErrorInput expose(servo::Task task, double time, const Eigen::Matrix3d& h, double d2, Noise& noise);

  // Distance [px] of the region's corner nearest to the image's border from it; negative if a corner is outside, or if
  // the region is not visible.
  double nearestToBorder(const Eigen::Matrix3d& h) const;

 private:
  bool isInImage(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d normalised(const Eigen::Vector2d& pixel) const;
  Eigen::Matrix3d pixels(const Eigen::Matrix3d& h) const;
  double nearestToBorder(const geometry::Quadrilateral& corners) const;
  double referenceInView(const Eigen::Matrix3d& g) const;
  double crossing(double time) const;
  void exposeView(const Eigen::Matrix3d& h, servo::TaskErrorInput& input, Noise& noise);
  void exposePlace(const Eigen::Matrix3d& g, const Eigen::Vector2d& desired, servo::TaskErrorInput& input,
                   Noise& noise) const;
  void exposePoints(const Eigen::Matrix3d& g, double d2, servo::TaskErrorInput& input, Noise& noise);
  std::optional<Eigen::Matrix3d> measured(const Eigen::Matrix3d& g, const geometry::Rectangle& region, bool whole,
                                          double sigma, Noise& noise) const;
  void exposeRegion(const Eigen::Matrix3d& g, bool whole, servo::TaskErrorInput& input, Noise& noise) const;
  void exposePosition(const Eigen::Matrix3d& g, double d2, servo::TaskErrorInput& input, Noise& noise) const;

  SimulationConfig config_;
  servo::ControllerConfig control_;
  Eigen::Matrix3d camera_R_shaft_;
  servo::PointsError points_error_;
  Eigen::Matrix3d picture_;  // takes the correct picture to the one shown, normalised coordinates
  std::optional<Eigen::Matrix3d> frozen_;
  std::optional<Eigen::Matrix3d> shown_before_;             // of the image before
  Eigen::Matrix3d followed_ = Eigen::Matrix3d::Identity();  // what was told of it
};

}  // namespace laparoscope_servo::closed_loop
