// What is known of a region of interest (ROI) from the images before: the last accepted estimate, the motion that is
// predicted from it, how well the ROI is usually aligned, and for how long it was not seen.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"
#include "tracking/align/quality.h"
#include "tracking/esm/esm.h"
#include "tracking/motion_filter.h"

namespace laparoscope_servo::tracking {

class RegionHistory {
 public:
  // See MotionFilter.
  explicit RegionHistory(double damping) : filter_(damping) {}
  void setDamping(double damping) { filter_.setDamping(damping); }

  // Starts at the reference, in the image at `stamp` [s]. `normalisation`: N of Esm, which must be that of `roi`.
  void start(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double stamp);
  // Starts at a reference of an older image, at `reference_stamp`, which is searched from `now` on.
  void startUnseen(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double reference_stamp,
                   double now);

  // See MotionFilter.
  MotionPrior predict(double stamp, const std::optional<Eigen::Matrix3d>& carried) const {
    return filter_.predict(stamp, carried);
  }
  // Adds to `evidence` what an estimate at `stamp` is compared with.
  void compare(double stamp, Evidence& evidence) const;

  // Takes an accepted estimate at `stamp`, found with `prior` while the ROI was tracked. `carried`: see MotionFilter.
  void addTracked(const Evidence& found, const MotionPrior& prior, double stamp,
                  const std::optional<Eigen::Matrix3d>& carried);
  // Takes the accepted and confirmed estimate of a search.
  void addFoundAgain(const Evidence& found, double stamp);
  // No estimate was accepted in this image.
  void addMiss() { filter_.stop(); }

  const EsmState& last() const { return last_; }  // the last accepted estimate
  const TrackRecord& record() const { return record_; }
  double sinceLast(double stamp) const { return stamp - filter_.lastStamp(); }  // s

 private:
  void take(const Evidence& found, double stamp);

  MotionFilter filter_;
  TrackRecord record_;
  EsmState last_;
  double proven_stamp_ = 0.0;    // s, of the last image in which blocks were where the estimate has them
  double proven_visible_ = 1.0;  // 0 to 1, the share of the ROI that was visible in it
  double unseen_before_ = 0.0;   // s, from the reference until it was recalled; 0 once it was found
};

}  // namespace laparoscope_servo::tracking
