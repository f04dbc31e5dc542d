// The start of a model's tracking from a pose that is known badly: several poses are tried, each is fitted to the whole
// image, and the one for which the edges speak is taken, unless they speak for another one nearly as much.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/model/model_config.h"
#include "model/outline.h"

namespace laparoscope_servo::model {

struct StartResult {
  features::EdgeReport report;  // of the best pose; its reason says why it is not taken
  double other_evidence = 0.0;  // the most for another pose
};

class ModelStart {
 public:
  // The configuration has to be valid.
  explicit ModelStart(const ModelConfig& config) : config_(config) {}

  // Changes `outline` to the best pose, and `fit` to the one that has learnt its looks.
  StartResult find(const cv::Mat& image, Outline& outline, features::EdgeFit& fit);

 private:
  ModelConfig config_;
};

}  // namespace laparoscope_servo::model
