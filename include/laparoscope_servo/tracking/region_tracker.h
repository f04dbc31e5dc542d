// Tracks a region of interest (ROI) of tissue, taken for a plane, through a sequence of images: ESM on SL(3) with
// detection of occlusions. Implements section II of Bourger et al. (2007), and adds a state that says whether the
// estimate is valid.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3); times are seconds, from the images' stamps. The tracker
// keeps no clock and no global state: the same images give the same results. It is not thread-safe.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/track_result.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

class RegionTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit RegionTracker(const TrackerConfig& config);
  ~RegionTracker();
  RegionTracker(RegionTracker&&) noexcept;
  RegionTracker& operator=(RegionTracker&&) noexcept;

  // From now on images are raw ones, seen through `lens`: the ROI and G are in rectified pixels, of a pinhole camera,
  // and the lens is put between them and the image where pixels are read. Without one (the default) images are those of
  // a pinhole camera. A lens that differs from the one before resets to IDLE, and the next image says so.
  void setLens(const std::optional<image::Lens>& lens);

  // From the next image on, the configuration's parameters that may change while the tracker runs, as describe() says
  // of each; the others stay as they are, and so does what is tracked. Throws std::invalid_argument that lists every
  // error, and leaves the tracker as it was.
  void retune(const TrackerConfig& config);

  // Takes `image` for the reference. Throws std::invalid_argument, with the ROI and what was expected, when the ROI is
  // empty, too small, mostly outside the image or without texture; the tracker then goes on as before. `external_mask`:
  // see track(); what it covers in the reference is never used.
  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi,
                     const cv::Mat& external_mask = cv::Mat());

  // Whether select() would take the ROI: throws as that would, and selects nothing.
  void check(const cv::Mat& image, const geometry::Rectangle& roi) const;

  // A region near `roi` whose texture is clearly enough to be tracked, where that of `roi` is not, or was not in what
  // followed: larger, or beside it. Empty where there is none. Throws std::invalid_argument for an image that select()
  // would not take, and for a ROI without size or number.
  std::optional<geometry::Rectangle> propose(const cv::Mat& image, const geometry::Rectangle& roi) const;

  // Takes an older image for the reference, whose ROI is then to be found in the images that come: SEARCHING, as after
  // a loss, since `now`, the stamp [s] of the next image or of one before it. `reference_stamp` may lie any time
  // before. Throws as select() does, and leaves the tracker as it was.
  void recall(const cv::Mat& reference, double reference_stamp, const geometry::Rectangle& roi, double now);

  // Processes the next image. A stamp before the last one, or an image of another size than the reference, resets to
  // IDLE with a reason. Throws std::invalid_argument for an image that is empty or of another type than those above;
  // the tracker then goes on as if the image had not come. `motion`: the ego-motion of the scope from another source
  // than the images (the robot), as a homography of any scale from pixels of the last image in state TRACKING to pixels
  // of this one. The search starts where it puts the ROI; only the motion that remains beside it is predicted to go on.
  // A motion that is no homography, or that leads to no accepted estimate, is ignored. `external_mask`: of this image,
  // in its own pixels (CV_8UC1, its size): what is not 0 is known to be covered, by an instrument, and is left out
  // before the gates decide; empty: nothing is known. Another size or type throws std::invalid_argument, as an image of
  // another type does. Does not allocate while tracking, but for a view that it stores now and then. The result belongs
  // to the tracker and is valid until the next call of select(), track() or reset(), or until the tracker is moved
  // from.
  const TrackResult& track(const cv::Mat& image, double stamp,
                           const std::optional<Eigen::Matrix3d>& motion = std::nullopt,
                           const cv::Mat& external_mask = cv::Mat());

  // Forgets the ROI.
  void reset();

  // Mask of the image processed last, in its own (raw) pixels: 255 where the ROI counts as occluded, 0 elsewhere; empty
  // before the first image. Drawn by this call.
  cv::Mat occlusionMask() const;

  bool hasRoi() const;
  const TrackerConfig& config() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::tracking
