#include "laparoscope_servo/sim/scope_camera.h"

#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/sim/texture.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::sim {

namespace {

constexpr int kNoiseMargin = 128;  // px

const SceneConfig& checked(const SceneConfig& config) {
  validation::throwErrors("scene", validate(config));
  return config;
}

cv::Mat texture(const TissueConfig& config) {
  if (!config.image.empty()) return textureFromFile(config.image);
  return tissueTexture(config.texture_side, static_cast<std::uint64_t>(config.seed));
}

// Mean of the image's brightness under that light, before the exposure's gain; every eighth pixel suffices.
double meanBrightness(const cv::Mat& image, const cv::Mat1f& light) {
  constexpr int kStep = 8;
  double sum = 0.0;
  int count = 0;
  for (int v = 0; v < image.rows; v += kStep) {
    for (int u = 0; u < image.cols; u += kStep, ++count) {
      const auto& pixel = image.at<cv::Vec3b>(v, u);
      sum += light(v, u) * (0.114 * pixel[0] + 0.587 * pixel[1] + 0.299 * pixel[2]);
    }
  }
  return sum / count;
}

void applyLight(cv::Mat& image, const cv::Mat1f& light, double gain) {
  const auto scale = static_cast<float>(gain);
  for (int v = 0; v < image.rows; ++v) {
    auto* row = image.ptr<cv::Vec3b>(v);
    for (int u = 0; u < image.cols; ++u) {
      const float factor = scale * light(v, u);
      for (int k = 0; k < 3; ++k) row[u][k] = cv::saturate_cast<uchar>(factor * row[u][k]);
    }
  }
}

}  // namespace

ScopeCamera::ScopeCamera(const SceneConfig& config, const Eigen::Isometry3d& base_T_tissue)
    : ScopeCamera(config, texture(checked(config).tissue), base_T_tissue) {}

ScopeCamera::ScopeCamera(const SceneConfig& config, const cv::Mat& texture, const Eigen::Isometry3d& base_T_tissue)
    : config_(checked(config)),
      tissue_(texture, config.tissue.width, base_T_tissue),
      lamp_(config.light, config.camera.intrinsics, {config.camera.width, config.camera.height},
            config.camera.border_radius),
      exposure_(config.exposure),
      random_(static_cast<std::uint64_t>(config.camera.noise_seed) ^ 0x9E3779B97F4A7C15ULL) {
  if (config.camera.noise > 0.0) {
    noise_.create(config.camera.height + kNoiseMargin, config.camera.width + kNoiseMargin, CV_32FC3);
    random_.fill(noise_, cv::RNG::NORMAL, 0.0, config.camera.noise);
  }
}

RenderedImage ScopeCamera::render(const Eigen::Isometry3d& base_T_camera, double time,
                                  const std::optional<Eigen::Vector3d>& tip) {
  const ScopeCameraConfig& camera = config_.camera;
  RenderedImage result;
  result.image = tissue_.view(camera.intrinsics, {camera.width, camera.height}, camera.supersampling, base_T_camera);
  const cv::Mat1f light = lamp_.onPlane(planeSeenFrom(base_T_camera, tissue_.pose()));
  result.gain = exposure_.update(meanBrightness(result.image, light), time);
  applyLight(result.image, light, result.gain);
  if (tip) {
    const Eigen::Isometry3d camera_T_tissue = base_T_camera.inverse() * tissue_.pose();
    std::vector<Capsule> capsules = instrumentAt(config_.instrument, *tip);
    for (Capsule& capsule : capsules) {
      capsule.a = camera_T_tissue * capsule.a;
      capsule.b = camera_T_tissue * capsule.b;
    }
    drawCapsules(capsules, camera.intrinsics, lamp_, result.gain, result.image, result.instrument_mask);
  }
  addNoise(result.image);
  return result;
}

void ScopeCamera::addNoise(cv::Mat& image) {
  if (noise_.empty()) return;
  const cv::Rect window(random_.uniform(0, kNoiseMargin + 1), random_.uniform(0, kNoiseMargin + 1), image.cols,
                        image.rows);
  cv::add(image, noise_(window), image, cv::noArray(), CV_8U);
}

}  // namespace laparoscope_servo::sim
