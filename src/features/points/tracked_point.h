// A point while it is tracked, and how it is told from what lies beside it.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "features/points/affine_fit.h"
#include "features/points/point_flow.h"
#include "features/points/point_image.h"
#include "features/points/point_search.h"
#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/features/points.h"

namespace laparoscope_servo::features {

struct TrackedPoint {
  explicit TrackedPoint(const StateConfig& config) : keeper(config) {}
  void begin() {
    reason = Reason::kNotSeen;
    followed = settled = false;
  }
  bool isSeen() const { return reason == Reason::kNone; }

  StateKeeper keeper;
  std::size_t group = 0;  // of the picture that shows its first view
  PointView view;
  FlowMemory memory;      // of the last image, if that showed it
  PointPose pose;         // where it is, or is expected
  PointPose expected;     // where it was looked for
  bool followed = false;  // from the last image
  bool settled = false;   // where the known motion puts it
  AffineFit fit;          // of the present image
  Reason reason = Reason::kNone;
};

// Of `from` by `motion`; `pose` stays where the motion takes it to no finite place, or mirrors it.
void placeBy(const Eigen::Matrix3d& motion, const Eigen::Vector2d& from, PointPose& pose);

class PointComparer {
 public:
  explicit PointComparer(const PointsConfig& config);

  // Compares the point with its first view, about where its pose is; sets `fit` and `reason`.
  void compare(const PointImage& now, TrackedPoint& point);
  // Looks for it around its pose; sets the pose where it is seen, and `fit`, `reason` and `expected`. It has to look
  // more alike than one that was followed: among many places some are alike by chance.
  void look(const PointImage& now, TrackedPoint& point);

 private:
  double max_correction_;                   // px
  double found_correlation_, found_share_;  // of what is found rather than followed
  AffineFitter fitter_;
  PointSearch search_;
};

}  // namespace laparoscope_servo::features
