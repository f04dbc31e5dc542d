// The tracker's parameters, as the nodelet and the offline tool read them.
#pragma once

#include <XmlRpcValue.h>

#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/tracking/input_config.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "laparoscope_servo/tracking/view_config.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/mask_input.h"
#include "ros/tracker/robot_motion.h"

namespace laparoscope_servo {

struct TrackerParameters {
  tracking::TrackerConfig tracking;
  tracking::InputConfig input;
  ImageFormat image{0, YuvRange::kLimited};  // a bit depth of 0: estimated
  std::optional<geometry::Rectangle> roi;    // px, selected in the first image
  bool rectified_images = false;             // images are rectified; P of camera_info applies
  bool rectify = false;                      // the tracker rectifies raw images
  RobotMotionConfig robot_motion;
  MaskInputConfig external_mask;
  tracking::ViewConfig views;
  double select_timeout = 5.0;  // s, longest time that a service waits for an image

  ImageKind imageKind() const {
    return rectify ? ImageKind::kToRectify : rectified_images ? ImageKind::kRectified : ImageKind::kRaw;
  }
};

// Of how pixels are stored: the rows, and every error beyond their ranges.
void describe(parameters::Table& table, ImageFormat& format);
std::vector<std::string> validate(const ImageFormat& format);

// Adds the rows of all parameters of the tracker.
void describe(parameters::Table& table, TrackerParameters& parameters);

// Every error, each naming the parameter, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const TrackerParameters& parameters);

// Reads `tree`, named `name` in errors; absent parameters keep their defaults. All errors are appended to `errors`; the
// result is valid only without errors. Unknown parameters are errors.
TrackerParameters readTrackerParameters(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                        std::vector<std::string>& errors);

// "x,y,width,height" in px. Throws std::invalid_argument with the error. Whether the rectangle lies in the image is
// checked later, with the image.
geometry::Rectangle parseRoi(const std::string& text);

// "x,y,width,height", as parseRoi reads it.
std::string roiText(const geometry::Rectangle& roi);

// All errors below a heading, one per line; empty if there are none.
std::string errorReport(const std::vector<std::string>& errors);

}  // namespace laparoscope_servo
