// Which parts of a model can be seen from a pose: faces that point to the camera, and the pieces of its strands that no
// part in front hides.
//
// Both have a hysteresis: a face appears when it is turned to the camera by more than where it disappears, and a piece
// appears when it is further from the outline of what hid it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "laparoscope_servo/model/cad_model.h"
#include "model/occluders.h"

namespace laparoscope_servo::model {

class Visibility {
 public:
  static constexpr int kPieces = 64;  // of each strand

  Visibility() = default;
  explicit Visibility(const CadModel& model);

  // From a new pose. `focal`: px, the mean of fx and fy. `step`: of so many pieces in a row one is looked at; a divisor
  // of kPieces. `occluders`: reserved for the model; overwritten. Does not allocate.
  void update(const CadModel& model, const Eigen::Isometry3d& camera_T_object, double focal, Occluders& occluders,
              int step = 1);
  // What was seen before is forgotten: the next update() has no hysteresis.
  void forget() { known_ = false; }

  bool faceIsSeen(int face) const { return faces_[static_cast<std::size_t>(face)] != 0; }
  bool isSeen(int strand, int piece) const { return pieces_[static_cast<std::size_t>(strand * kPieces + piece)] != 0; }

 private:
  bool isTurnedToUs(double sine, bool was) const;
  bool pointsHere(const CadModel& model, int strand) const;

  std::vector<char> faces_, circles_, pieces_;
  bool known_ = false;
};

}  // namespace laparoscope_servo::model
