// Tracks points of texture (Marchand and Chaumette 2004, II.C): corners of Shi and Tomasi, followed from image to image
// by translation, and compared with their first view by an affine motion with gain and offset of the light. The place
// that is told is that of the comparison, so it does not drift.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3), all of one size and type; times are seconds, from the
// images' stamps. The tracker keeps no clock and no global state: the same images give the same results. It is not
// thread-safe. It does not allocate while at least three points of each picture are seen; when fewer are, it matches
// that picture as a whole now and then (recall_period), which does.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

struct PointsConfig {
  int window = 21;               // px, side of the window that is compared; odd
  int levels = 4;                // of the pyramid: with each one more a point may move twice as far from image to image
  double corner_quality = 0.02;  // weakest corner that is chosen, relative to the strongest
  double min_distance = 12.0;    // px between corners that are chosen
  int saturation = 250;          // grey levels: pixels as bright in any channel are not compared
  double min_correlation = 0.8;  // with the first view
  double min_share = 0.5;        // of the window's texture that agrees with the first view
  double max_error = 0.5;        // px: expected of a point
  double max_scale = 3.0;        // by which a window may grow or shrink since the first view
  double max_distortion = 2.0;   // ratio of its growth along two directions
  double search_range = 16.0;    // px: how far from where the others say a point is looked for that is not seen
  double recall_period = 0.5;    // s: how often the first view is matched as a whole while it is out of sight; 0: never
  StateConfig state;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, PointsConfig& config);
// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const PointsConfig& config);

// The `count` best corners in `region` of the image - its windows' smaller singular value of R, eq. (2) - strongest
// first, without those whose window is saturated or black, or touches the image's border. An empty region: the whole
// image.
std::vector<Eigen::Vector2d> findCorners(const cv::Mat& image, const cv::Rect& region, int count,
                                         const PointsConfig& config);

// Points that are told by their places in one picture.
struct PointGroup {
  cv::Mat picture;                      // CV_8UC1 or CV_8UC3, of any size; empty: the image in which they are selected
  std::vector<Eigen::Vector2d> places;  // px of the picture
};

struct PointResult {
  State state = State::kIdle;
  Reason reason = Reason::kNothingSelected;              // why the state is not TRACKING
  Eigen::Vector2d place = Eigen::Vector2d::Zero();       // px; unless TRACKING, where it is expected
  Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();   // takes what lies around it in the first view to the image
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // px^2, of the place
  double expected_error = 0.0;  // px, standard deviation along its worst axis; infinite unless TRACKING
  double gain = 1.0;            // of the light: gain x image + offset looks like the first view
  double offset = 0.0;          // grey levels
  double correlation = 0.0;     // with the first view, -1 to 1
  double share = 0.0;           // of the window's texture that agrees with it, 0 to 1
};

struct PointsResult {
  State state = State::kIdle;  // TRACKING: all of them are; else the worst of theirs, and its reason
  Reason reason = Reason::kNothingSelected;
  std::vector<PointResult> points;  // in the order of their selection
  bool selected_now = false;
};

class PointTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit PointTracker(const PointsConfig& config = {});
  ~PointTracker();
  PointTracker(PointTracker&&) noexcept;
  PointTracker& operator=(PointTracker&&) noexcept;

  // Throws std::invalid_argument, with the group or the point and what was expected, when a point has no texture that
  // tells where it is, or a picture is not found in the image; the tracker then goes on as before. Of a picture that is
  // found single points may be SEARCHING.
  const PointsResult& select(const cv::Mat& image, double stamp, const std::vector<PointGroup>& groups);

  // Processes the next image. A stamp before the last one, or an image of another size or type than the selection's,
  // resets to IDLE, with the reason. `motion`: takes pixels of the last image to pixels of this one, where something
  // else knows it; one that is no homography is ignored. The result lasts until the next call.
  const PointsResult& track(const cv::Mat& image, double stamp,
                            const std::optional<Eigen::Matrix3d>& motion = std::nullopt);

  // Forgets the points.
  void reset();

  const PointsResult& result() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::features
