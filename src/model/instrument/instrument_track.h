// One instrument through a sequence of images.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "features/shafts/grey_levels.h"
#include "features/shafts/silhouette.h"
#include "laparoscope_servo/features/curve_tracker.h"
#include "laparoscope_servo/features/line.h"
#include "laparoscope_servo/model/instruments.h"
#include "model/instrument/axis_meeting.h"

namespace laparoscope_servo::model {

using features::GreyLevels;
using features::GreyLine;
using features::GreyMap;
using features::Shaft;
using features::Silhouette;

// The image that is processed, and what its colours say.
struct InstrumentScene {
  const cv::Mat& image;
  const cv::Mat1b& plane;  // what the fine stage looks at
  double stamp;            // s
  const std::optional<Eigen::Matrix3d>& motion;
  const GreyMap& map;
  const image::FieldOfView& view;
  const GreyLevels& levels;
};

class InstrumentTrack {
 public:
  // Of a shaft that `scene` shows.
  InstrumentTrack(const InstrumentConfig& config, int id, const InstrumentScene& scene, const Shaft& found);

  // Moves what is expected on by the camera's motion, where that is known. Call before isExpectedAt() and update().
  void predict(const InstrumentScene& scene);
  // Whether a shaft that was found in the image may be this instrument.
  bool isExpectedAt(const InstrumentScene& scene, const Shaft& found) const;
  // `found`: what was found at its place; null where nothing was.
  void update(const InstrumentScene& scene, const Shaft* found);

  features::State state() const { return keeper_.state(); }
  const Shaft& shaft() const { return shaft_; }
  int id() const { return id_; }
  // How many of its edges the fine stage has found.
  int fineEdges() const;
  void tell(const GreyMap& map, const std::optional<geometry::PinholeCamera>& camera, Instrument& result) const;
  void draw(const GreyMap& map, double threshold, cv::Mat1b& mask);

 private:
  void trackEdges(const InstrumentScene& scene);
  void checkEdges(const InstrumentScene& scene, const Shaft& found);
  bool agrees(const GreyMap& map, std::size_t k, const GreyLine& coarse) const;
  double edgeError(const GreyMap& map, std::size_t k) const;

  InstrumentConfig config_;
  int id_;
  features::StateKeeper keeper_;
  std::array<features::CurveTracker<features::Line>, 2> edges_;
  std::array<bool, 2> fine_{false, false};
  std::array<int, 2> failed_{0, 0};   // images since the fine stage was tried
  std::array<int, 2> strayed_{0, 0};  // images in a row in which it differs from the outline of what is grey
  Shaft shaft_;
  Silhouette silhouette_, kept_;
  Shaft kept_shaft_;
  int missed_ = 0;  // images in a row that have not shown it
  AxisMeeting meeting_;
};

}  // namespace laparoscope_servo::model
