#include "ros/tracker/tracker_parameters.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "ros/common/parameter_names.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

using parameters::Table;
using parameters::Value;

namespace {

constexpr double kMaxPixel = 65535.0;

void describe(Table& table, MaskInputConfig& config) {
  table.flag("enabled", config.enabled, "masks on ~external_mask are used; in track_bag by --instruments");
  table.text("owner", config.owner, "whose masks are accepted; empty: those of the first that publishes")
      .accepting("the name of a node, e.g. instrument or /manager, or nothing",
                 [](const std::string& name) { return name.empty() || isNodeName(name); });
  table.number("max_age", config.max_age, {0, 1}, "s",
               "while the mask of an image is not there, an earlier one is used as predicted, up to this age; 0: none");
}

bool isRoiOrNothing(const std::string& text) {
  try {
    if (!text.empty()) parseRoi(text);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// Converts a region given as a group of four numbers to the text form of the table.
void groupToText(XmlRpc::XmlRpcValue& roi, const std::string& name, std::vector<std::string>& errors) {
  if (roi.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  geometry::Rectangle rectangle;
  Table table;
  table.number("x", rectangle.x, {0, kMaxPixel}, "px", "left edge").required("580");
  table.number("y", rectangle.y, {0, kMaxPixel}, "px", "upper edge").required("180");
  table.number("width", rectangle.width, {1, kMaxPixel}, "px", "across").required("220");
  table.number("height", rectangle.height, {1, kMaxPixel}, "px", "down").required("340");
  ParameterReader reader(roi, name);
  reader.read(table);
  reader.refuseUnknown("");
  errors.insert(errors.end(), reader.errors().begin(), reader.errors().end());
  roi = reader.errors().empty() ? roiText(rectangle) : std::string();
}

}  // namespace

void describe(Table& table, ImageFormat& format) {
  table.number("bit_depth", format.bit_depth, {0, 16}, "bits",
               "8 to 16, the lowest ones, that images of 16 bit use; 0: found out from the largest value seen");
  table.choice("yuv_range", format.yuv_range, {"limited", "full"},
               "of YUV images: Y from 16 to 235, as of video, or from 0 to 255, as of many webcams");
}

std::vector<std::string> validate(const ImageFormat& format) {
  if (format.bit_depth <= 0 || format.bit_depth >= 8) return {};
  return {"bit_depth = " + std::to_string(format.bit_depth) + ", expected 0, or 8 to 16"};
}

void describe(Table& table, TrackerParameters& parameters) {
  table
      .other(
          "roi", parameters::Row::Kind::kText,
          [&roi = parameters.roi] { return Value(roi ? roiText(*roi) : std::string()); },
          [&roi = parameters.roi](const Value& value) {
            const auto& text = std::get<std::string>(value);
            roi = text.empty() ? std::nullopt : std::make_optional(parseRoi(text));
          },
          "px, region that is selected in the first image; also as a group {x: 580, y: 180, width: 220, height: 340}")
      .accepting("x,y,width,height, e.g. 580,180,220,340, each in [0, 65535], the sides at least 1, or nothing",
                 isRoiOrNothing)
      .optional("580,180,220,340");
  table.flag("rectified_images", parameters.rectified_images,
             "the images are rectified: P of camera_info applies to them, otherwise K");
  table.flag("rectify", parameters.rectify,
             "the images are raw, and the tracker takes the lens out by camera_info; pixels, also of roi, are then "
             "rectified ones. Not with rectified_images");
  table.number("select_timeout", parameters.select_timeout, {0.1, 60}, "s",
               "for which select_roi, store_view and recall_view wait for an image");
  table.group("image", "how pixels are stored", [&] { describe(table, parameters.image); });
  table.group("input", "which images are accepted", [&] { describe(table, parameters.input); });
  table.group("robot_motion", "in the nodelet: the ego-motion prior, by the camera's motion in tf",
              [&] { describe(table, parameters.robot_motion); });
  table.group("external_mask", "in the nodelet: what another node knows to cover the tissue, as instruments",
              [&] { describe(table, parameters.external_mask); });
  table.group("views", "of the nodelet: stored and recalled under a name", [&] { describe(table, parameters.views); });
  table.group("tracking", "", [&] { describe(table, parameters.tracking); });
}

std::vector<std::string> validate(const TrackerParameters& parameters) {
  std::vector<std::string> errors = parameters::errorsOf(parameters);
  if (parameters.rectify && parameters.rectified_images)
    errors.emplace_back("rectify = true beside rectified_images = true, expected one of them at most");
  for (const std::string& error : validate(parameters.image)) errors.push_back("image/" + error);
  return errors;
}

TrackerParameters readTrackerParameters(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                        std::vector<std::string>& errors) {
  TrackerParameters parameters;
  XmlRpc::XmlRpcValue words = tree;
  if (tree.valid() && tree.getType() == XmlRpc::XmlRpcValue::TypeStruct && tree.hasMember("roi"))
    groupToText(words["roi"], name + "/roi", errors);
  ParameterReader reader(words, name);
  Table table;
  describe(table, parameters);
  reader.read(table);
  reader.refuseUnknownOfNode();
  if (reader.errors().empty()) reader.addJudgement(validate(parameters));
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
  std::string text;
  for (const double number : {roi.x, roi.y, roi.width, roi.height})
    text += (text.empty() ? "" : ",") + validation::numberText(number);
  return text;
}

std::string errorReport(const std::vector<std::string>& errors) {
  if (errors.empty()) return "";
  std::string text =
      std::to_string(errors.size()) + (errors.size() == 1 ? " error" : " errors") + " in the parameters:";
  for (const std::string& error : errors) text += "\n  " + error;
  return text;
}

}  // namespace laparoscope_servo
