// Tracks dots - bright on dark or dark on bright, round or nearly so - by their centres of gravity (Marchand and
// Chaumette 2004, II.A): several, each with a state of its own.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3), all of one size and type; times are seconds, from the
// images' stamps. The tracker keeps no clock and no global state: the same images give the same results. It is not
// thread-safe, and does not allocate while tracking.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

struct DotsConfig {
  double range = 20.0;            // px: how far a dot may be from where it is expected
  double min_contrast = 20.0;     // grey levels between dot and background
  double min_radius = 2.5;        // px
  double max_radius = 60.0;       // px
  double max_area_change = 0.2;   // from one image to the next, relative
  double max_roughness = 0.3;     // px by which the outline may differ from an ellipse, in any of its twelve parts
  double max_error = 0.5;         // px: expected of the centre
  double velocity_damping = 0.8;  // share of the last motion that is expected to go on
  StateConfig state;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, DotsConfig& config);
// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const DotsConfig& config);

struct DotResult {
  State state = State::kIdle;
  Reason reason = Reason::kNothingSelected;              // why the state is not TRACKING
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();      // px; unless TRACKING, where it is expected
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // px^2, of the centre
  double expected_error = 0.0;  // px, standard deviation along its worst axis; infinite unless TRACKING
  double area = 0.0;            // px^2
  double level = 0.0;           // grey levels, inside
  double background = 0.0;      // grey levels, around it
};

struct DotsResult {
  State state = State::kIdle;  // TRACKING: all of them are; SEARCHING: one is not, LOST: one is; `reason` is its reason
  Reason reason = Reason::kNothingSelected;
  std::vector<DotResult> dots;  // in the order of their selection
  bool selected_now = false;
};

class DotTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit DotTracker(const DotsConfig& config = {});
  ~DotTracker();
  DotTracker(DotTracker&&) noexcept;
  DotTracker& operator=(DotTracker&&) noexcept;

  // Each point lies in a dot of its own, or next to one. Throws std::invalid_argument, with the point and what was
  // expected, when one has no dot, or two have the same one; the tracker then goes on as before.
  const DotsResult& select(const cv::Mat& image, double stamp, const std::vector<Eigen::Vector2d>& points);

  // Processes the next image. A stamp before the last one, or an image of another size or type than the selection's,
  // resets to IDLE, with the reason. `motion`: takes pixels of the last image to pixels of this one, where something
  // else knows it; one that is no homography is ignored. A dot that is not seen is expected where the others say. The
  // result lasts until the next call.
  const DotsResult& track(const cv::Mat& image, double stamp,
                          const std::optional<Eigen::Matrix3d>& motion = std::nullopt);

  // Forgets the dots.
  void reset();

  const DotsResult& result() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::features
