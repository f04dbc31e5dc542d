// Images with edges whose place is known: a region, drawn with 8 x 8 samples a pixel, blurred, with noise.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::test {

struct EdgeScene {
  cv::Size size{320, 240};
  double dark = 90.0;     // grey levels, outside of the region
  double bright = 150.0;  // inside
  double blur = 1.0;      // px
  double noise = 2.0;     // grey levels
  unsigned seed = 1;
  cv::Mat1f background;  // instead of `dark`, where it is not empty
};

// 1 inside, 0 outside; p in px.
using Region = std::function<bool(const Eigen::Vector2d& p)>;

inline cv::Mat1f coverage(const cv::Size& size, const Region& region) {
  constexpr int kSamples = 8;
  cv::Mat1f result(size);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      // Corners first: most pixels lie on one side.
      int sum = 0;
      const Eigen::Vector2d p(u, v);
      const bool any = region(p + Eigen::Vector2d(-0.7, -0.7));
      const bool whole = any == region(p + Eigen::Vector2d(0.7, -0.7)) &&
                         any == region(p + Eigen::Vector2d(-0.7, 0.7)) &&
                         any == region(p + Eigen::Vector2d(0.7, 0.7)) && any == region(p);
      if (whole) {
        result(v, u) = any ? 1.0f : 0.0f;
        continue;
      }
      for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) {
          sum += region(p + Eigen::Vector2d((i + 0.5) / kSamples - 0.5, (j + 0.5) / kSamples - 0.5)) ? 1 : 0;
        }
      }
      result(v, u) = static_cast<float>(sum) / (kSamples * kSamples);
    }
  }
  return result;
}

// CV_8UC1. `cover`: painted over it afterwards, before blur and noise.
inline cv::Mat draw(const EdgeScene& scene, const Region& region,
                    const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  const cv::Mat1f inside = coverage(scene.size, region);
  cv::Mat1f image(scene.size, static_cast<float>(scene.dark));
  if (!scene.background.empty()) scene.background.copyTo(image);
  image = image.mul(1.0f - inside) + static_cast<float>(scene.bright) * inside;
  if (cover) cover(image);
  if (scene.blur > 0.0) cv::GaussianBlur(image, image, cv::Size(), scene.blur, scene.blur, cv::BORDER_REFLECT_101);
  if (scene.noise > 0.0) {
    cv::Mat1f grain(scene.size);
    cv::RNG rng(scene.seed);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, scene.noise);
    image += grain;
  }
  cv::Mat result;
  image.convertTo(result, CV_8UC1);
  return result;
}

// A smooth random texture about `mean`, with a standard deviation of `contrast` grey levels.
inline cv::Mat1f texture(const cv::Size& size, double mean, double contrast, double scale, unsigned seed) {
  cv::Mat1f result(size);
  cv::RNG rng(seed);
  rng.fill(result, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(result, result, cv::Size(), scale);
  result = result * static_cast<float>(contrast * 3.545 * scale) + static_cast<float>(mean);
  return result;
}

// Of the points on the side that the normal (cos(theta), sin(theta)) points to.
inline Region halfPlane(double rho, double theta) {
  const Eigen::Vector2d n(std::cos(theta), std::sin(theta));
  return [=](const Eigen::Vector2d& p) { return n.dot(p) > rho; };
}

inline Region ellipse(const Eigen::Vector2d& centre, double a, double b, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return [=](const Eigen::Vector2d& p) {
    const Eigen::Vector2d d = p - centre;
    const double x = (c * d.x() + s * d.y()) / a, y = (c * d.y() - s * d.x()) / b;
    return x * x + y * y < 1.0;
  };
}

}  // namespace laparoscope_servo::test
