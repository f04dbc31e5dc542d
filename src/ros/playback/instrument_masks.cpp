#include "ros/playback/instrument_masks.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "ros/features/feature_parameters.h"
#include "ros/playback/offline_options.h"

namespace laparoscope_servo {

InstrumentMaskOptions readInstrumentMaskOptions(int late, double max_age) {
  std::vector<std::string> errors;
  const std::string name = "instrument.yaml";
  const auto parameters =
      readFeatureParameters<model::InstrumentConfig>(readOfflineTree(name, ""), "config/" + name, errors);
  if (!errors.empty()) throw std::runtime_error(errorReport(errors));
  return {parameters.tracking, late, max_age};
}

InstrumentMasks::InstrumentMasks(const InstrumentMaskOptions& options)
    : late_(options.late), tracker_(options.tracking), masks_(options.max_age) {
  if (late_ >= 0 && late_ <= 100) return;
  throw std::invalid_argument("masks that are " + std::to_string(late_) + " images late, expected 0 to 100");
}

tracking::ExternalMask InstrumentMasks::of(const cv::Mat& image, const ros::Time& stamp) {
  const double time = stamp.toSec();
  const cv::Mat& mask = tracker_.track(image, time).mask;
  if (!under_way_.empty() && !(time > under_way_.back().first)) under_way_.clear();
  under_way_.emplace_back(time, mask.clone());
  while (under_way_.size() > static_cast<std::size_t>(late_)) {
    masks_.add(under_way_.front().second, under_way_.front().first);
    under_way_.pop_front();
  }
  return masks_.at(time, image.size());
}

}  // namespace laparoscope_servo
