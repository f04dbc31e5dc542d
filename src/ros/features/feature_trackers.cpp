#include "ros/features/feature_trackers.h"

#include <stdexcept>

#include "laparoscope_servo/features/dot_feature_tracker.h"
#include "laparoscope_servo/features/edge_feature_tracker.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "laparoscope_servo/model/cad_model.h"
#include "laparoscope_servo/model/instrument_feature_tracker.h"
#include "laparoscope_servo/model/model_feature_tracker.h"
#include "laparoscope_servo/motion/motion_feature_tracker.h"
#include "laparoscope_servo/tracking/contour_texture.h"

namespace laparoscope_servo {

namespace {

using Maker = std::unique_ptr<features::FeatureTracker> (*)(const XmlRpc::XmlRpcValue&, const std::string&,
                                                            FeatureInput&, std::vector<std::string>&);

// `Config`: what `Tracker` is made from, with rows of its own in the table of parameters.
template <class Tracker, class Config>
std::unique_ptr<features::FeatureTracker> make(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                               FeatureInput& input, std::vector<std::string>& errors) {
  const auto parameters = readFeatureParameters<Config>(tree, name, errors);
  if (!errors.empty()) return nullptr;
  input = parameters.common;
  return std::make_unique<Tracker>(parameters.tracking);
}

std::unique_ptr<features::FeatureTracker> makeModel(const XmlRpc::XmlRpcValue& tree, const std::string& name,
                                                    FeatureInput& input, std::vector<std::string>& errors) {
  const ModelParameters parameters = readFeatureParameters<ModelFileConfig>(tree, name, errors);
  if (!errors.empty()) return nullptr;
  input = parameters.common;
  try {
    return std::make_unique<model::ModelFeatureTracker>(model::readCadModel(parameters.tracking.file),
                                                        parameters.tracking.tracker);
  } catch (const model::CadFileError& error) {
    errors.push_back(name + "/tracking/file: " + error.what());
    return nullptr;
  }
}

const struct {
  const char* name;
  Maker maker;
} kTrackers[] = {{"dots", make<features::DotFeatureTracker, features::DotsConfig>},
                 {"edges", make<features::EdgeFeatureTracker, features::EdgeConfig>},
                 {"points", make<features::PointFeatureTracker, features::PointsConfig>},
                 {"contour", make<tracking::ContourTextureTracker, tracking::ContourTextureConfig>},
                 {"instrument", make<model::InstrumentFeatureTracker, model::InstrumentConfig>},
                 {"model", makeModel},
                 {"motion", make<motion::MotionFeatureTracker, motion::MotionConfig>}};

}  // namespace

std::vector<std::string> featureTrackers() {
  std::vector<std::string> names;
  for (const auto& each : kTrackers) names.emplace_back(each.name);
  return names;
}

std::unique_ptr<features::FeatureTracker> makeFeatureTracker(const std::string& kind, const XmlRpc::XmlRpcValue& tree,
                                                             const std::string& name, FeatureInput& input,
                                                             std::vector<std::string>& errors) {
  std::string known;
  for (const auto& each : kTrackers) {
    if (kind == each.name) return each.maker(tree, name, input, errors);
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw std::invalid_argument("tracker '" + kind + "', expected one of " + known);
}

}  // namespace laparoscope_servo
