#include "laparoscope_servo/sim/light.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::sim {

Lamp::Lamp(const LightConfig& config, const geometry::PinholeCamera& camera, const cv::Size& size, double border_radius)
    : config_(config), camera_(camera), falloff_(size), ray_length_(size) {
  const double middle_u = (size.width - 1.0) / 2.0, middle_v = (size.height - 1.0) / 2.0;
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double length = std::hypot(1.0, std::hypot((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy));
      double inside = 1.0;
      if (border_radius > 0.0) {
        inside = std::clamp(border_radius + 0.5 - std::hypot(u - middle_u, v - middle_v), 0.0, 1.0);
      }
      ray_length_(v, u) = static_cast<float>(length);
      falloff_(v, u) = static_cast<float>(inside * std::pow(length, -3.0 - config.beam_exponent));
    }
  }
}

cv::Mat1f Lamp::onPlane(const Plane& plane) const {
  cv::Mat1f light = cv::Mat1f::zeros(falloff_.size());
  if (!(plane.distance > 0.0)) return light;
  // With X = m d / (n'm): cos = n'm / |m| and |X| = |m| d / n'm, hence cos / |X|² = (n'm)³ / (|m|³ d²).
  const auto scale = static_cast<float>(std::pow(config_.reference_distance / plane.distance, 2));
  const auto step = static_cast<float>(plane.normal.x() / camera_.fx);
  for (int v = 0; v < light.rows; ++v) {
    const auto first = static_cast<float>(-plane.normal.x() * camera_.cx / camera_.fx +
                                          plane.normal.y() * (v - camera_.cy) / camera_.fy + plane.normal.z());
    const float* falloff = falloff_[v];
    float* result = light[v];
    for (int u = 0; u < light.cols; ++u) {
      const float cosine = std::max(0.0F, first + step * static_cast<float>(u));
      result[u] = scale * cosine * cosine * cosine * falloff[u];
    }
  }
  return light;
}

float Lamp::onSurface(int u, int v, double z) const {
  // Distance |m| z, no cosine: falloff has |m|^-3, of which |m|^-2 belongs to the distance.
  const auto ratio = static_cast<float>(config_.reference_distance / z);
  return ratio * ratio * falloff_(v, u) * ray_length_(v, u);
}

double Exposure::update(double mean, double time) {
  if (!config_.automatic) return gain_;
  const double wanted = std::clamp(config_.target / std::max(mean, 1e-3), 0.01, 100.0);
  const double elapsed = time - last_time_;
  const double share = started_ && elapsed >= 0.0 ? 1.0 - std::exp(-elapsed / config_.time_constant) : 1.0;
  gain_ *= std::pow(wanted / gain_, share);
  started_ = true;
  last_time_ = time;
  return gain_;
}

}  // namespace laparoscope_servo::sim
