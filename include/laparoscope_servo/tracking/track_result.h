// What the tracker says of one image.
#pragma once

#include <Eigen/Core>
#include <string>

#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/area_report.h"

namespace laparoscope_servo::tracking {

// The values are those of Homography.msg and of the offline tool's table.
using features::State;
using features::stateName;

struct TrackResult {
  State state = State::kIdle;
  std::string reason;                               // why the state is not TRACKING; empty when it is
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // reference to current pixels, determinant 1; finite in every state
  geometry::Rectangle roi;                          // in the reference image, px
  double reference_stamp = 0.0;                     // s
  double visible_fraction = 0.0;                    // 0 to 1, share of the ROI's pixels that the estimate used
  double zncc = 0.0;                                // -1 to 1, over those pixels, with the mean of each area subtracted
  int iterations = 0;                               // iterations of ESM, over all levels
  // px, expected standard deviation of the worst corner, by residuals, motion prior and what the tissue deforms by
  double corner_error = 0.0;
  // px, expected standard deviation of the ROI's centre, which may be small where corner_error is large
  double centre_error = 0.0;
  double corner_scatter = 0.0;  // px, corner_error without deformation: how the worst corner varies between images
  double sigma = 0.0;           // grey levels, robust standard deviation of the residual
  double gain = 1.0;            // gain * image + bias has the illumination of the reference
  double bias = 0.0;            // grey levels
  bool colour_used = false;     // false: the image has no colour, the colour gate is inactive
  AreaReport areas;
  bool selected_now = false;  // this image is the reference
  bool motion_used = false;   // this estimate started from the `motion` given
};

}  // namespace laparoscope_servo::tracking
