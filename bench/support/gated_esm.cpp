#include "bench/support/gated_esm.h"

namespace laparoscope_servo::bench {

GatedEsm::GatedEsm(const tracking::TrackerConfig& config, const cv::Mat& image, const geometry::Rectangle& roi)
    : config_(config),
      esm_(config.esm),
      gates_(config.occlusion, config.esm.saturation),
      size_(static_cast<int>(roi.width), static_cast<int>(roi.height)) {
  build(image);
  esm_.setReference(pyramid_, roi);
  image_T_patch_.topRightCorner<2, 1>() << roi.x, roi.y;
  image::warpNearest(image, image_T_patch_, size_, patch_);
  gates_.setReference(patch_);
}

tracking::EsmResult GatedEsm::align(const cv::Mat& image, const Eigen::Matrix3d& start) {
  build(image);
  esm_.forgetLight();
  gates_.forget();
  look(image, start);
  tracking::EsmState state;
  state.g = start;
  tracking::EsmResult result = esm_.align(pyramid_, state);
  if (!usable(result) || !config_.occlusion.structure) return result;
  look(image, result.state.g);
  observeStructure(result);
  esm_.setWeights(gates_.weights());
  const int iterations = result.iterations;
  result = esm_.align(pyramid_, result.state, 0, 0);
  result.iterations += iterations;
  if (usable(result)) observeStructure(result);
  return result;
}

bool GatedEsm::usable(const tracking::EsmResult& result) {
  return result.status == tracking::EsmStatus::kConverged || result.status == tracking::EsmStatus::kMaxIterations;
}

void GatedEsm::build(const cv::Mat& image) {
  pyramid_.build(image, cv::Rect(0, 0, image.cols, image.rows), config_.esm.levels, image::kLuma);
}

void GatedEsm::look(const cv::Mat& image, const Eigen::Matrix3d& g) {
  image::warpNearest(image, g * image_T_patch_, size_, patch_);
  gates_.observeColour(patch_);
  esm_.setWeights(gates_.weights());
}

int GatedEsm::observeStructure(const tracking::EsmResult& result) {
  const tracking::EsmLevel& level = esm_.level(0);
  return gates_.observeStructure(level.warped, level.value, level.valid, result.state.gain, result.sigma);
}

}  // namespace laparoscope_servo::bench
