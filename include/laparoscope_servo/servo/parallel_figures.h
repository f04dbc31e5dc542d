// What the task PARALLEL knows of the tissue, and how far it is.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

enum class ParallelStage {
  kUnknown,    // the normal is not known: engaging begins with the circle
  kCircle,     // the scope goes round
  kSettles,    // the normal is known, and the arm comes to rest
  kAnnounced,  // what the turn will do from where the arm stands was said
  kTurn,       // the optical axis is turned onto the normal, and held there
};

struct ParallelFigures {
  ParallelStage stage = ParallelStage::kUnknown;
  int views = 0;        // that were gathered
  double stddev = 0.0;  // rad, of the normal; 0 without views enough
  bool is_known = false;
  // In the frame of the insertion point, when known: the plane normal'X = distance [m], and the normal in the camera's
  // frame at the last pose, unit vectors from the scope into the tissue.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double distance = 0.0;
  Eigen::Vector3d normal_in_camera = Eigen::Vector3d::Zero();
};

}  // namespace laparoscope_servo::servo
