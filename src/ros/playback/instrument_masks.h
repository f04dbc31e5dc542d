// The instrument tracker beside the region tracker, offline: its silhouettes are the region tracker's external masks.
#pragma once

#include <ros/time.h>

#include <deque>
#include <opencv2/core.hpp>
#include <utility>

#include "laparoscope_servo/model/instruments.h"
#include "laparoscope_servo/tracking/external_masks.h"

namespace laparoscope_servo {

struct InstrumentMaskOptions {
  model::InstrumentConfig tracking;
  // Images by which masks come late, as between nodes; 0: each is there for its own image.
  int late = 0;
  double max_age = 0.0;  // s, see tracking::ExternalMasks
};

// The parameters of the package's config/instrument.yaml. Throws std::runtime_error with everything that is wrong.
InstrumentMaskOptions readInstrumentMaskOptions(int late, double max_age);

class InstrumentMasks {
 public:
  // Throws std::invalid_argument for options that cannot be used.
  explicit InstrumentMasks(const InstrumentMaskOptions& options);

  // Finds the instruments of the next image, and returns what the region tracker is given for it. Throws
  // std::invalid_argument for an image without colour. Valid until the next call.
  tracking::ExternalMask of(const cv::Mat& image, const ros::Time& stamp);

 private:
  int late_;
  model::InstrumentTracker tracker_;
  tracking::ExternalMasks masks_;
  std::deque<std::pair<double, cv::Mat>> under_way_;  // stamp and mask
};

}  // namespace laparoscope_servo
