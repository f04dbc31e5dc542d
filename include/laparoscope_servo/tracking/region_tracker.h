// Tracks a region of interest (ROI) of tissue, taken for a plane, through a sequence of images: ESM on SL(3) with
// detection of occlusions. The whole of section II of Bourger et al. (2007), with states that say what may be believed.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3); times are seconds, from the images' stamps. The tracker
// keeps no clock and no global state: the same images give the same results. It is not thread-safe.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/area_cause.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// The values are those of Homography.msg and of the offline tool's table.
enum class State { kIdle = 0, kTracking = 1, kSearching = 2, kLost = 3 };

const char* stateName(State state);

// The ROI's areas, row by row. Empty while no ROI is selected.
struct AreaReport {
  int rows = 0;
  int columns = 0;
  std::vector<float> distance;  // eq. (2), 0 to 1; NaN where an area could not be compared
  std::vector<bool> occluded;   // did not drive ESM
  std::vector<AreaCause> cause;
};

struct TrackResult {
  State state = State::kIdle;
  std::string reason;                               // why the state is not TRACKING; empty when it is
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // reference to current pixels, determinant 1; finite in every state
  geometry::Rectangle roi;                          // in the reference image, px
  double reference_stamp = 0.0;                     // s
  double visible_fraction = 0.0;                    // 0 to 1, share of the ROI's pixels that the estimate used
  double zncc = 0.0;                                // -1 to 1, over those pixels, the mean of each area taken out
  int iterations = 0;                               // of ESM, all levels
  double corner_error = 0.0;  // px, standard deviation expected of the worst corner, by residuals and motion
  double centre_error = 0.0;  // px, the same of the ROI's centre, which may be known where the corners are not
  double corner_scatter =
      0.0;             // px, of corner_error, what changes from image to image: without what the tissue deforms by
  double sigma = 0.0;  // grey levels, robust standard deviation of the residual
  double gain = 1.0;   // gain * image + bias has the light of the reference
  double bias = 0.0;   // grey levels
  bool colour_used = false;  // false: the image has no colour, the colour gate stands aside
  AreaReport areas;
  bool selected_now = false;  // this image is the reference
  bool motion_used = false;   // the motion that was given led to this estimate
};

class RegionTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit RegionTracker(const TrackerConfig& config);
  ~RegionTracker();
  RegionTracker(RegionTracker&&) noexcept;
  RegionTracker& operator=(RegionTracker&&) noexcept;

  // From now on images are raw ones, seen through `lens`: the ROI and G are in rectified pixels, of a pinhole camera,
  // and the lens is put between them and the image where pixels are read. Without one (the default) images are what a
  // pinhole camera sees. A lens that differs from the one before resets to IDLE, and the next image says so.
  void setLens(const std::optional<image::Lens>& lens);

  // From the next image on, the configuration's parameters that may change while the tracker runs, as describe() says
  // of each; the others stay as they are, and so does what is tracked. Throws std::invalid_argument that lists every
  // error, and leaves the tracker as it was.
  void retune(const TrackerConfig& config);

  // Takes `image` for the reference. Throws std::invalid_argument, with the ROI and what was expected, when the ROI is
  // empty, too small, mostly outside the image or without texture; the tracker then goes on as before.
  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi);

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
  // IDLE, with the reason. Throws std::invalid_argument for an image that is empty or of another type than those above;
  // the tracker then goes on as if the image had not come. `motion`: where something else than the images, a robot,
  // says that the tissue has gone: takes pixels of the last image in which the state was TRACKING to pixels of this
  // one, any scale. It gives the place to start from; only the motion that remains beside it is predicted to go on. A
  // motion that is no homography, or from which no estimate is accepted, is ignored. Does not allocate while tracking,
  // but for a view that it stores now and then. The result is the tracker's own: it lasts until the next call of
  // select(), track() or reset(), or until the tracker is moved from.
  const TrackResult& track(const cv::Mat& image, double stamp,
                           const std::optional<Eigen::Matrix3d>& motion = std::nullopt);

  // Forgets the ROI.
  void reset();

  // 255 where a pixel of the ROI, as seen in the image that was processed last, is taken for occluded, 0 elsewhere;
  // empty before the first image. Of that image's size and pixels, also with a lens. Drawn only when asked for.
  cv::Mat occlusionMask() const;

  bool hasRoi() const;
  const TrackerConfig& config() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::tracking
