// The one interface of the survey's trackers (Marchand and Chaumette 2004), behind which nodelets and tools use them.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3); times are seconds, from the images' stamps. A tracker
// keeps no clock and no global state: the same images give the same results. Not thread-safe. Does not allocate while
// tracking.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/features/feature_selection.h"
#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::features {

// What else is known of an image, before it is looked at.
struct FeaturePrior {
  // Takes pixels of the last image to pixels of this one. One that is no homography is ignored.
  std::optional<Eigen::Matrix3d> motion;
  // Takes coordinates in the camera's frame of the last image to those in this one's, of what is at rest.
  std::optional<Eigen::Isometry3d> camera_motion;
  // Of this image, without distortion; trackers in pixels do not need it.
  std::optional<geometry::PinholeCamera> camera;
  // CV_8UC1 of the image's size: what is not 0 lies in front of the tissue. Empty: nothing is known. Used by trackers
  // of motion.
  cv::Mat mask;
};

class FeatureTracker {
 public:
  virtual ~FeatureTracker() = default;

  // Takes `selection` in place of what was tracked. Throws std::invalid_argument, with the feature's id, what was found
  // and what was expected; the tracker then goes on as before.
  virtual const TrackedFeatures& select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                        const FeaturePrior& prior) = 0;

  // Processes the next image. A stamp before the last one, or an image of another size or type than that of the
  // selection, resets to IDLE, with the reason. Throws std::invalid_argument for an image of a type that it cannot use,
  // and goes on as if that had not come. The result lasts until the next call.
  virtual const TrackedFeatures& track(const cv::Mat& image, double stamp, const FeaturePrior& prior) = 0;

  // Forgets the features.
  virtual void reset() = 0;

  // Of the last call.
  virtual const TrackedFeatures& features() const = 0;

  // Nothing has to be selected: it looks for its features itself.
  virtual bool findsByItself() const { return false; }
  // Something can be selected.
  virtual bool takesSelection() const { return !findsByItself(); }

  // Whether poses may be among its features.
  virtual bool givesPoses() const { return false; }

  // Whether mask() tells something. CV_8UC1 of the last image's size: 255 where something lies in front of the tissue,
  // else 0; empty before the first image.
  virtual bool givesMask() const { return false; }
  virtual cv::Mat mask() const { return {}; }
};

}  // namespace laparoscope_servo::features
