// Calibrates the insertion point from poses of a shaft that swings about it, by hand or by motors: estimates the point
// and its uncertainty, and checks whether that is good enough.
//
// Poses whose shafts differ in direction are kept; their lines go into the estimator of insertion_point_estimator.h
// without a prior, so that only the poses decide.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/servo/insertion_point_estimator.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct InsertionPointFitConfig {
  double spacing = 0.005;           // rad: a pose is kept if its direction differs by at least this from all others
  int min_poses = 30;               // least number of poses kept, 5 to half of max_poses
  int max_poses = 300;              // largest number of poses kept; beyond it the spacing is increased
  double min_cone = 0.07;           // rad: root mean square of the directions from their mean
  double max_residual = 0.003;      // m, root mean square distance of the shafts from the point
  double max_stddev = 0.003;        // m, of the point along its worst axis
  double position_noise = 0.0005;   // m, of a pose, standard deviation per axis
  double direction_noise = 0.0035;  // rad, of a shaft's direction, standard deviation per axis
  double wobble = 0.001;            // m, standard deviation of the point's motion with breathing
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, InsertionPointFitConfig& config);

std::vector<std::string> validate(const InsertionPointFitConfig& config);

struct InsertionPointFit {
  int poses = 0;                                         // number of poses kept
  bool known = false;                                    // there is a point; problems() checks whether it can be used
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // m, base frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m²; never less than the configured noise allows
  double stddev = 0.0;                                   // m, along the worst axis
  double cone = 0.0;                                     // rad, as min_cone
  double residual = 0.0;                                 // m, root mean square over all poses kept
  double largest_residual = 0.0;                         // m
  // m, least distance along the shafts from their points to the fit
  double nearest = 0.0;
  double farthest = 0.0;  // m
};

class InsertionPointFitter {
 public:
  // Throws std::invalid_argument with all errors when the configuration is not valid.
  explicit InsertionPointFitter(const InsertionPointFitConfig& config);

  // Returns whether the shaft is kept for now. A shaft that is not finite, or whose direction is not of unit length, is
  // not.
  bool add(const Shaft& shaft);

  // Indices, from 0, of the shafts passed to add() that are still kept.
  const std::vector<std::size_t>& kept() const { return kept_; }
  const InsertionPointFit& fit() const { return fit_; }
  // What the fit lacks, each with its value and what is expected; empty if it can be used. `length` [m]: from a shaft's
  // point to its far end; the insertion point must be in between.
  std::vector<std::string> problems(double length) const;

 private:
  bool insert(const Shaft& shaft, std::size_t number);
  void thinOut();
  void measure();

  InsertionPointFitConfig config_;
  double spacing_;  // rad
  InsertionPointEstimator estimator_;
  std::size_t taken_ = 0;
  std::vector<Shaft> shafts_;
  std::vector<std::size_t> kept_;  // indices into shafts_
  InsertionPointFit fit_;
};

}  // namespace laparoscope_servo::servo
