// Finds and tracks surgical instruments, up to three, without a selection: shafts that are grey, have two straight
// edges and enter through the border of the picture; their tips; and the part of the picture that they cover.
//
// Images are 8 bit, blue-green-red (CV_8UC3), all of one size; times are seconds, from the images' stamps. The tracker
// keeps no clock and no global state: the same images give the same results. It is not thread-safe.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/features/instrument_mask.h"
#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/model/cylinder_pose.h"

namespace laparoscope_servo::model {

struct InstrumentConfig {
  int most = 3;           // instruments at a time
  int confirmations = 5;  // images in a row that show a new one, before it is taken for an instrument
  // Of an instrument that is believed at once, relative to the tissue's colour.
  double clear_contrast = features::kClearContrast;
  double min_fill = 0.6;         // share of what lies between the edges that is grey
  double radius = 0.0;           // m, of the shaft; 0: not known, no pose
  double max_search_time = 2.0;  // s: SEARCHING for longer is LOST
  features::EdgeConfig edges;    // of the fine stage
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, InstrumentConfig& config);
// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const InstrumentConfig& config);

// An edge of a shaft: x cos(theta) + y sin(theta) = rho. The normal (cos(theta), sin(theta)) points away from the
// shaft.
struct InstrumentEdge {
  bool seen = false;   // false: it lies beyond the picture
  bool fine = false;   // fitted to the image's edges; false: only to the outline of what is grey
  double rho = 0.0;    // px
  double theta = 0.0;  // rad, (-pi, pi]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of (rho, theta): px^2, px rad, rad^2
  Eigen::Vector2d begin = Eigen::Vector2d::Zero();       // px, where it is seen to begin, at the entry
  Eigen::Vector2d end = Eigen::Vector2d::Zero();         // px, towards the tip
  double expected_error = 0.0;                           // px, standard deviation along the normal, at its worst point
  std::vector<features::TrackedSite> sites;              // of the fit to the image's edges; empty unless fine
};

struct Instrument {
  int id = 0;  // counts up; one that comes back after LOST may get a new one
  features::State state = features::State::kIdle;
  features::Reason reason = features::Reason::kNone;  // why the state is not TRACKING
  // Right and left of who looks from the entry to the tip. In states other than TRACKING where they are expected.
  std::array<InstrumentEdge, 2> edges;
  Eigen::Vector2d entry = Eigen::Vector2d::Zero();  // px, of the axis into the picture
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  // direction in the image, towards the tip
  Eigen::Vector2d tip = Eigen::Vector2d::Zero();    // px, what lies furthest along the axis
  double tip_error = 0.0;                           // px, standard deviation expected along the axis
  double expected_error = 0.0;                      // px, of the worse edge; infinite unless TRACKING
  // Where both edges meet, homogeneous px: the vanishing point of the axis. Nearly (x, y, 0) for parallel edges.
  Eigen::Vector3d vanishing_point = Eigen::Vector3d::UnitX();
  std::optional<Eigen::Vector2d> trocar;  // px, where its axes have met while the camera rested
  std::optional<CylinderPose> pose;       // needs camera, radius, and both edges
};

struct InstrumentsResult {
  std::vector<Instrument> instruments;
  // CV_8UC1, size of the image, 255 where an instrument is or may be: its silhouette, grown by twice the error that is
  // expected of it. SEARCHING: where it was seen last. LOST: not in it.
  cv::Mat mask;
};

class InstrumentTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit InstrumentTracker(const InstrumentConfig& config = {});
  ~InstrumentTracker();
  InstrumentTracker(InstrumentTracker&&) noexcept;
  InstrumentTracker& operator=(InstrumentTracker&&) noexcept;

  // Intrinsics of a camera without distortion, for the pose. Throws std::invalid_argument for one that cannot be used.
  void setCamera(const std::optional<geometry::PinholeCamera>& camera);

  // Processes the next image. A stamp before the last one, or an image of another size, forgets all instruments.
  // `motion`: what the camera's own motion does to pixels of the last image, where something else knows it; identity
  // says that it rests. Throws std::invalid_argument for an image that is empty or has no colour, and a stamp that is
  // not finite; tracking then goes on as if the image had not come. The result lasts until the next call.
  const InstrumentsResult& track(const cv::Mat& image, double stamp,
                                 const std::optional<Eigen::Matrix3d>& motion = std::nullopt);

  // Forgets all instruments.
  void reset();
  const InstrumentsResult& result() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::model
