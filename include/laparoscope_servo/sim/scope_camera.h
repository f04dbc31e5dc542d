// The simulated laparoscope's camera: renders tissue and instrument from its pose.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/sim/instrument.h"
#include "laparoscope_servo/sim/light.h"
#include "laparoscope_servo/sim/scene_config.h"
#include "laparoscope_servo/sim/tissue.h"

namespace laparoscope_servo::sim {

struct RenderedImage {
  cv::Mat image;            // CV_8UC3, blue, green, red
  cv::Mat instrument_mask;  // CV_8UC1, 255 where the instrument covers the tissue; empty when there is none
  double gain = 1.0;        // gain of the exposure
};

// The same poses and times in the same order give the same images.
class ScopeCamera {
 public:
  // Throws std::invalid_argument that lists every error of the configuration, std::runtime_error if the texture's file
  // cannot be read.
  ScopeCamera(const SceneConfig& config, const Eigen::Isometry3d& base_T_tissue);
  // With this texture, CV_8UC3, in place of the configured one.
  ScopeCamera(const SceneConfig& config, const cv::Mat& texture, const Eigen::Isometry3d& base_T_tissue);

  // The image from this pose at `time` [s], with the instrument's tip at `tip` (tissue's frame, m) if there is one.
  RenderedImage render(const Eigen::Isometry3d& base_T_camera, double time,
                       const std::optional<Eigen::Vector3d>& tip = std::nullopt);

  // Another texture, CV_8UC3, from the next image on: of tissue on which something moves. Throws std::invalid_argument.
  void setTexture(const cv::Mat& texture) { tissue_ = Tissue(texture, config_.tissue.width, tissue_.pose()); }

  const SceneConfig& config() const { return config_; }
  const Tissue& tissue() const { return tissue_; }

 private:
  void addNoise(cv::Mat& image);

  SceneConfig config_;
  Tissue tissue_;
  Lamp lamp_;
  Exposure exposure_;
  cv::RNG random_;
  cv::Mat noise_;  // CV_32FC3, larger than the image; a window at a random place is the noise of an image
};

}  // namespace laparoscope_servo::sim
