#include "laparoscope_servo/sim/instrument.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::sim {

namespace {

constexpr double kNear = 0.005;  // m

struct Nearest {
  double distance;  // m, between the ray and the segment
  double depth;     // m, z of the ray's point
};

// Nearest points of the ray t m, t > 0, and the segment from a to b.
Nearest nearest(const Eigen::Vector3d& m, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d e = b - a;
  const double mm = m.squaredNorm(), me = m.dot(e), ee = e.squaredNorm();
  const double determinant = mm * ee - me * me;  // 0 when parallel, or when the segment is a point
  double along = 0.0;
  if (determinant > 1e-18) along = std::clamp((me * m.dot(a) - mm * e.dot(a)) / determinant, 0.0, 1.0);
  const Eigen::Vector3d on_segment = a + along * e;
  const double t = std::max(0.0, m.dot(on_segment) / mm);
  return {(on_segment - t * m).norm(), t * m.z()};
}

// Cuts off the part behind z = kNear. Returns false if nothing is left.
bool cut(Eigen::Vector3d& a, Eigen::Vector3d& b) {
  if (a.z() < kNear && b.z() < kNear) return false;
  Eigen::Vector3d& behind = a.z() < b.z() ? a : b;
  const Eigen::Vector3d& other = a.z() < b.z() ? b : a;
  if (behind.z() < kNear) behind += (other - behind) * (kNear - behind.z()) / (other.z() - behind.z());
  return true;
}

// A rectangle that contains the image of the capsule: that of the boxes around the spheres at its ends.
cv::Rect bounds(const Capsule& c, const geometry::PinholeCamera& camera, const cv::Size& size) {
  Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9);
  for (const Eigen::Vector3d& p : {c.a, c.b}) {
    for (const double z : {std::max(p.z() - c.radius, kNear / 2.0), p.z() + c.radius}) {
      least = least.cwiseMin((p.head<2>().array() - c.radius).matrix() / z);
      most = most.cwiseMax((p.head<2>().array() + c.radius).matrix() / z);
    }
  }
  const auto pixel = [](double value, int limit) { return static_cast<int>(std::clamp(value, -1.0, limit + 1.0)); };
  const cv::Point first(pixel(camera.fx * least.x() + camera.cx - 1.0, size.width),
                        pixel(camera.fy * least.y() + camera.cy - 1.0, size.height));
  const cv::Point last(pixel(camera.fx * most.x() + camera.cx + 2.0, size.width),
                       pixel(camera.fy * most.y() + camera.cy + 2.0, size.height));
  return cv::Rect(first, last) & cv::Rect(cv::Point(0, 0), size);
}

}  // namespace

std::optional<Eigen::Vector3d> instrumentTip(const InstrumentConfig& config, double elapsed) {
  if (!(elapsed >= 0.0 && elapsed <= config.crossing_time)) return std::nullopt;
  return Eigen::Vector3d(config.start + (config.end - config.start) * elapsed / config.crossing_time);
}

std::vector<Capsule> instrumentAt(const InstrumentConfig& config, const Eigen::Vector3d& tip) {
  const Eigen::Vector3d back = (config.trocar - tip).normalized();
  const double r = config.radius;
  const Eigen::Vector3d wrist = tip + 5.0 * r * back;
  return {{tip, wrist, 0.6 * r, {112.0F, 112.0F, 108.0F}},                       // steel jaws
          {wrist + r * back, wrist + 3.0 * r * back, r, {90.0F, 90.0F, 86.0F}},  // steel collar
          {wrist + 3.0 * r * back, config.trocar, r, {24.0F, 21.0F, 20.0F}}};    // insulated shaft
}

void drawCapsules(const std::vector<Capsule>& capsules, const geometry::PinholeCamera& camera, const Lamp& lamp,
                  double gain, cv::Mat& image, cv::Mat& mask) {
  mask = cv::Mat::zeros(image.size(), CV_8UC1);
  cv::Mat1f nearest_depth(image.size(), std::numeric_limits<float>::max());
  for (Capsule capsule : capsules) {
    if (!cut(capsule.a, capsule.b)) continue;
    const cv::Rect box = bounds(capsule, camera, image.size());
    for (int v = box.y; v < box.y + box.height; ++v) {
      for (int u = box.x; u < box.x + box.width; ++u) {
        const Eigen::Vector3d m((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
        const Nearest hit = nearest(m, capsule.a, capsule.b);
        const double pixel = hit.depth / camera.fx;  // m, size of a pixel there
        const double cover = std::clamp((capsule.radius - hit.distance) / pixel + 0.5, 0.0, 1.0);
        if (!(cover > 0.0) || hit.depth > nearest_depth(v, u)) continue;

        // Towards the outline the surface turns away from lamp and camera and gets darker.
        const double across = std::min(1.0, hit.distance / capsule.radius);
        const double facing = std::sqrt(1.0 - across * across);
        const double light = gain * lamp.onSurface(u, v, hit.depth);
        const auto diffuse = static_cast<float>(light * (0.15 + 0.85 * facing));
        const auto shine = static_cast<float>(light * 60.0 * std::pow(facing, 40.0));
        auto& target = image.at<cv::Vec3b>(v, u);
        for (int k = 0; k < 3; ++k) {
          const float colour = capsule.colour[k] * diffuse + shine;
          target[k] = cv::saturate_cast<uchar>(cover * std::min(colour, 255.0F) + (1.0 - cover) * target[k]);
        }
        if (cover >= 0.5) {
          mask.at<uchar>(v, u) = 255;
          nearest_depth(v, u) = static_cast<float>(hit.depth);
        }
      }
    }
  }
}

}  // namespace laparoscope_servo::sim
