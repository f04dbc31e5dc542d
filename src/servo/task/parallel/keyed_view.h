// The task error of the view against an image that the scope has not left far behind, for the guard of effect.
//
// PARALLEL leads the view away from the anchor image: what is left of that is far outside, where small errors of the
// homography are large. So the view is compared with a later image, the key, and with another one whenever the middle
// of the key has gone too far.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "laparoscope_servo/servo/task_function.h"
#include "laparoscope_servo/servo/view_motion.h"

namespace laparoscope_servo::servo {

struct KeyedError {
  TaskError error;           // against the key; its log depth goes on from key to key
  double key = 0.0;          // identifies the key
  bool key_changed = false;  // this image is the key
  TaskError last_key;        // the same against the key before, where it changed
};

class KeyedView {
 public:
  void restart() { key_H_anchor_.reset(); }

  // Of the image of `time` [s]; the same time gives the same again. Empty where the homography takes the view to where
  // no camera sees it.
  std::optional<KeyedError> see(double time, const ViewMotion& motion);

 private:
  std::optional<Eigen::Matrix3d> key_H_anchor_;
  double log_depth_ = 0.0;  // of the key
  double key_ = 0.0;
  std::optional<double> time_;
  std::optional<KeyedError> last_;
};

}  // namespace laparoscope_servo::servo
