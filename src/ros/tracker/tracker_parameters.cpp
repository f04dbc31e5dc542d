#include "ros/tracker/tracker_parameters.h"

#include <ros/names.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "ros/common/parameters.h"

namespace laparoscope_servo {

namespace {

constexpr double kMaxPixel = 65535.0;

// One of `names`, which are in the order of the enumeration's values.
template <typename Enum>
void readEnum(ParameterReader& reader, const std::string& path, const std::vector<std::string>& names, Enum& value) {
  std::string name = names[static_cast<std::size_t>(value)];
  reader.read(path, name, names);
  value = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

void readOcclusion(ParameterReader& reader, tracking::OcclusionConfig& config) {
  // "none" rather than "off", which YAML takes for a boolean.
  readEnum(reader, "tracking/occlusion/colour", {"none", "published", "normalised"}, config.colour);
  reader.read("tracking/occlusion/rows", config.rows, 2, 64);
  reader.read("tracking/occlusion/columns", config.columns, 2, 64);
  reader.read("tracking/occlusion/bins", config.bins, 4, 256);
  reader.read("tracking/occlusion/threshold", config.threshold, 0.0, 1.0);
  reader.read("tracking/occlusion/structure", config.structure);
  reader.read("tracking/occlusion/hold", config.hold, 0, 100);
}

void readEsm(ParameterReader& reader, tracking::EsmConfig& config) {
  reader.read("tracking/esm/levels", config.levels, 1, 6);
  reader.read("tracking/esm/max_iterations", config.max_iterations, 1, 100);
  reader.read("tracking/esm/min_step", config.min_step, 0.0001, 1.0);
  readEnum(reader, "tracking/esm/light", {"constant", "global", "local"}, config.light);
  reader.read("tracking/esm/robust", config.robust);
  reader.read("tracking/esm/saturation", config.saturation, 1, 256);
  readEnum(reader, "tracking/esm/channels", {"luma", "strongest", "colour"}, config.channels);
}

void readQuality(ParameterReader& reader, tracking::QualityConfig& config) {
  reader.read("tracking/quality/min_zncc", config.min_zncc, 0.0, 1.0);
  reader.read("tracking/quality/min_visible_fraction", config.min_visible_fraction, 0.0, 1.0);
  reader.read("tracking/quality/min_return_fraction", config.min_return_fraction, 0.0, 1.0);
  reader.read("tracking/quality/max_corner_error", config.max_corner_error, 0.01, 100.0);
  reader.read("tracking/quality/max_centre_error", config.max_centre_error, 0.01, 100.0);
  reader.read("tracking/quality/max_area_ratio", config.max_area_ratio, 1.01, 1000.0);
  reader.read("tracking/quality/max_jump", config.max_jump, 0.01, 10.0);
  reader.read("tracking/quality/max_search_time", config.max_search_time, 0.0, 3600.0);
  reader.read("tracking/quality/confirmations", config.confirmations, 1, 100);
}

void readSearch(ParameterReader& reader, tracking::SearchConfig& config) {
  reader.read("tracking/search/features", config.features);
  reader.read("tracking/search/correlation", config.correlation);
  reader.read("tracking/search/max_features", config.max_features, 50, 5000);
  reader.read("tracking/search/max_pixels", config.max_pixels, 10000, 10000000);
  reader.read("tracking/search/max_ratio", config.max_ratio, 0.1, 1.0);
  reader.read("tracking/search/min_inliers", config.min_inliers, 4, 1000);
  reader.read("tracking/search/keyframes", config.keyframes, 0, 64);
  reader.read("tracking/search/min_detail", config.min_detail, 0.0, 1.0);
  reader.read("tracking/search/budget", config.budget, 0.001, 10.0);
}

void readTracking(ParameterReader& reader, tracking::TrackerConfig& config) {
  readOcclusion(reader, config.occlusion);
  readEsm(reader, config.esm);
  readQuality(reader, config.quality);
  readSearch(reader, config.search);
  reader.read("tracking/velocity_damping", config.velocity_damping, 0.0, 1.0);
  reader.read("tracking/min_roi_side", config.min_roi_side, 8, 1000);
  reader.read("tracking/min_texture", config.min_texture, 0.01, 10.0);
}

void readInput(ParameterReader& reader, tracking::InputConfig& config) {
  reader.read("input/max_repeats", config.max_repeats, 0, 25);
  reader.read("input/max_still_repeats", config.max_still_repeats, 0, 1000);
  reader.read("input/moving", config.moving, 0.05, 100.0);
  reader.read("input/moved", config.moved, 0.1, 100.0);
  reader.read("input/restart_images", config.restart_images, 2, 100);
  reader.read("input/loop_step", config.loop_step, 0.1, 1e6);
  reader.read("input/max_gap", config.max_gap, 0.1, 1e6);
  reader.read("input/max_ahead", config.max_ahead, 0.0, 10.0);
}

void readImage(ParameterReader& reader, const std::string& name, ImageFormat& format) {
  reader.read("image/bit_depth", format.bit_depth, 0, 16);
  if (format.bit_depth > 0 && format.bit_depth < 8) {
    reader.addError(name + "/image/bit_depth is " + std::to_string(format.bit_depth) + ", expected 0, or 8 to 16");
  }
  readEnum(reader, "image/yuv_range", {"limited", "full"}, format.yuv_range);
}

// A string "x,y,width,height" (empty: none), or a group of four numbers.
void readRoi(ParameterReader& reader, const std::string& name, std::optional<geometry::Rectangle>& roi) {
  if (!reader.has("roi")) return;
  bool is_group = false;
  for (const char* part : {"roi/x", "roi/y", "roi/width", "roi/height"}) is_group = is_group || reader.has(part);
  if (!is_group) {
    std::string text;
    reader.read("roi", text);
    if (text.empty()) return;
    try {
      roi = parseRoi(text);
    } catch (const std::invalid_argument& error) {
      reader.addError(name + "/roi: " + error.what());
    }
    return;
  }
  geometry::Rectangle rectangle;
  const std::string what = "px, with x, y, width and height";
  for (const char* part : {"roi/x", "roi/y", "roi/width", "roi/height"}) reader.require(part, what);
  reader.read("roi/x", rectangle.x, 0.0, kMaxPixel);
  reader.read("roi/y", rectangle.y, 0.0, kMaxPixel);
  reader.read("roi/width", rectangle.width, 1.0, kMaxPixel);
  reader.read("roi/height", rectangle.height, 1.0, kMaxPixel);
  roi = rectangle;
}

void readRobotMotion(ParameterReader& reader, const std::string& name, RobotMotionConfig& config) {
  reader.read("robot_motion/enabled", config.enabled);
  reader.read("robot_motion/fixed_frame", config.fixed_frame);
  reader.read("robot_motion/frame_prefix", config.frame_prefix);
  reader.read("robot_motion/owner", config.owner);
  reader.read("robot_motion/depth", config.depth, 0.005, 1.0);
  if (config.fixed_frame.empty() || config.fixed_frame[0] == '/') {
    reader.addError(name + "/robot_motion/fixed_frame is '" + config.fixed_frame +
                    "', expected the name of a tf frame, without a leading slash");
  }
  std::string why;
  if (!config.owner.empty() && (config.owner.front() == '~' || !ros::names::validate(config.owner, why))) {
    reader.addError(name + "/robot_motion/owner is '" + config.owner +
                    "', expected the name of a node, e.g. aesop or /aesop, or nothing");
  }
}

void readViews(ParameterReader& reader, tracking::ViewConfig& config) {
  reader.read("views/capacity", config.capacity, 1, 256);
  reader.read("views/min_visible_fraction", config.min_visible_fraction, 0.0, 1.0);
  reader.read("views/arrival_centre", config.arrival_centre, 0.1, 10000.0);
  reader.read("views/arrival_scale", config.arrival_scale, 0.001, 1.0);
}

}  // namespace

TrackerParameters readTrackerParameters(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                        std::vector<std::string>& errors) {
  TrackerParameters parameters;
  ParameterReader reader(tree, name);
  readTracking(reader, parameters.tracking);
  readInput(reader, parameters.input);
  readImage(reader, name, parameters.image);
  readRoi(reader, name, parameters.roi);
  readRobotMotion(reader, name, parameters.robot_motion);
  readViews(reader, parameters.views);
  bool rectified = false;
  reader.read("rectified_images", rectified);
  bool rectify = false;
  reader.read("rectify", rectify);
  if (rectify && rectified) {
    reader.addError(name + "/rectify: true beside rectified_images: true, expected one of them at most");
  }
  parameters.image_kind = rectify ? ImageKind::kToRectify : rectified ? ImageKind::kRectified : ImageKind::kRaw;
  reader.read("select_timeout", parameters.select_timeout, 0.1, 60.0);
  reader.refuseUnknownOfNode();
  if (reader.errors().empty()) reader.addErrors(tracking::validate(parameters.tracking));
  errors.insert(errors.end(), reader.errors().begin(), reader.errors().end());
  return parameters;
}

geometry::Rectangle parseRoi(const std::string& text) {
  const std::string expected = "ROI '" + text + "', expected x,y,width,height in px, e.g. 580,180,220,340";
  double values[4];
  int count = 0;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    while (end != nullptr && *end == ' ') ++end;
    if (count == 4 || part.empty() || end == part.c_str() || *end != '\0') throw std::invalid_argument(expected);
    values[count++] = value;
  }
  if (count != 4 || text.back() == ',') throw std::invalid_argument(expected);
  for (const double value : values) {
    if (!(value >= 0.0 && value <= kMaxPixel)) throw std::invalid_argument(expected + ", each from 0 to 65535");
  }
  if (!(values[2] >= 1.0) || !(values[3] >= 1.0)) {
    throw std::invalid_argument(expected + ", with a width and a height of at least 1");
  }
  return {values[0], values[1], values[2], values[3]};
}

std::string roiText(const geometry::Rectangle& roi) {
  std::ostringstream stream;
  stream << roi.x << ',' << roi.y << ',' << roi.width << ',' << roi.height;
  return stream.str();
}

std::string errorReport(const std::vector<std::string>& errors) {
  if (errors.empty()) return "";
  std::string text =
      std::to_string(errors.size()) + (errors.size() == 1 ? " error" : " errors") + " in the parameters:";
  for (const std::string& error : errors) text += "\n  " + error;
  return text;
}

}  // namespace laparoscope_servo
