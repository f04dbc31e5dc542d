// The parameters that the nodelets of all trackers of features share, and those of each.
#pragma once

#include <XmlRpcValue.h>

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "laparoscope_servo/features/dots.h"
#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_selection.h"
#include "laparoscope_servo/features/points.h"
#include "laparoscope_servo/model/instruments.h"
#include "laparoscope_servo/motion/motion_config.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/tracking/contour_texture.h"
#include "laparoscope_servo/tracking/input_config.h"
#include "ros/common/parameters.h"
#include "ros/features/model_file_config.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/robot_motion.h"

namespace laparoscope_servo {

struct FeatureInput {
  std::string selection;          // file, see selection_text.h, selected in the first image; empty: none
  bool rectified_images = false;  // P of camera_info applies
  double select_timeout = 5.0;    // s
  ImageFormat image{0, YuvRange::kLimited};
  tracking::InputConfig input;
  RobotMotionConfig robot_motion;
  bool publish_tf = false;  // of trackers that give poses
};

// `Config`: of the tracker, with describe() and validate().
template <class Config>
struct FeatureParameters {
  FeatureInput common;
  Config tracking;
};

using DotsParameters = FeatureParameters<features::DotsConfig>;
using PointsParameters = FeatureParameters<features::PointsConfig>;
using ContourParameters = FeatureParameters<tracking::ContourTextureConfig>;
using EdgesParameters = FeatureParameters<features::EdgeConfig>;
using InstrumentParameters = FeatureParameters<model::InstrumentConfig>;
using MotionParameters = FeatureParameters<motion::MotionConfig>;
using ModelParameters = FeatureParameters<ModelFileConfig>;

// Whether poses may be among the features of the tracker that is made from `Config`.
template <class Config>
constexpr bool kGivesPoses = std::is_same_v<Config, model::InstrumentConfig> || std::is_same_v<Config, ModelFileConfig>;

void describe(parameters::Table& table, FeatureInput& input);
std::vector<std::string> validate(const FeatureInput& input);

template <class Config>
void describe(parameters::Table& table, FeatureParameters<Config>& parameters) {
  describe(table, parameters.common);
  if constexpr (kGivesPoses<Config>)
    table.flag("publish_tf", parameters.common.publish_tf,
               "each pose is also on tf, from the image's frame to NODE/ID; ~pose is there in any case");
  table.group("tracking", "", [&] { describe(table, parameters.tracking); });
}

template <class Config>
std::vector<std::string> validate(const FeatureParameters<Config>& parameters) {
  std::vector<std::string> errors = validate(parameters.common);
  for (const std::string& error : validate(parameters.tracking)) errors.push_back("tracking/" + error);
  return errors;
}

// Reads `tree`, named `name` in errors; absent parameters keep their defaults. All errors are appended to `errors`; the
// result is valid only without errors. Unknown parameters are errors.
template <class Config>
FeatureParameters<Config> readFeatureParameters(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                                std::vector<std::string>& errors) {
  FeatureParameters<Config> parameters;
  ParameterReader reader(tree, name);
  reader.readAll(parameters);
  errors.insert(errors.end(), reader.errors().begin(), reader.errors().end());
  return parameters;
}

}  // namespace laparoscope_servo
