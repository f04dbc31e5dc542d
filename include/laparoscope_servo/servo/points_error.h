// The task error of points that shall be seen at desired places, for the task POINTS.
//
// The robust law of Marchand and Chaumette (2004), II.C, v = -lambda (D L)^+ D e, with lambda = 1, applied again and
// again to where the points would be seen, leads from the desired view to the present one. It starts from the
// similarity of two points that brings most points together, for a step is good only near the truth. The displacement
// of the scope between the two has the task error of a region in the points' middle; so everything behind it is as for
// a region, and FeatureLaw with one rate lambda for all features gives that law. Points that were taken for others, or
// that move otherwise than most, have no say (D).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/robust_point_law.h"
#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

struct PointsSeen {
  bool is_known = false;  // false: too few points agree, or they do not tell the view
  TaskError error;        // its desired place is the middle; zero unless known, as what follows
  int agreeing = 0;       // points that have a say
  double stddev = 0.0;    // normalised, of a place in the points' common view: 4 unknowns, by what the points differ
};

class PointsError {
 public:
  // `desired_depth` Z* [m] of the points in the desired view, where they lie in a plane across the optical axis. An
  // error of it changes the speed of convergence only.
  PointsError(const PointsConfig& config, double desired_depth);

  // Of each point `point`, `desired` and `weight` are used. `middle`: normalised, of the desired places. `scope`: its
  // optics, and d2 [m] now. Does not allocate for up to as many points as before.
  PointsSeen from(const std::vector<PointTask>& points, const Eigen::Vector2d& middle, const scope::Geometry& scope);

 private:
  // Displacement from the desired view by the similarity on which most points agree; zero where none is.
  Eigen::Vector4d start(const Eigen::Vector2d& middle, const scope::Geometry& scope);
  void reset(const std::vector<PointTask>& points);
  bool predict(const Eigen::Vector4d& displacement, const scope::Geometry& scope);

  PointsConfig config_;
  double desired_depth_;  // m
  RobustPointLaw law_;
  std::vector<std::size_t> usable_;
  std::vector<double> distances_;
  std::vector<PointTask> steps_;  // from where a point would be seen to where it is
};

}  // namespace laparoscope_servo::servo
