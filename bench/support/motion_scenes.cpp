#include "bench/support/motion_scenes.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "bench/support/synthetic.h"

namespace laparoscope_servo::bench {

namespace {

constexpr int kMargin = 160;     // px of the canvas around the first image
constexpr double kOffset = 0.3;  // px: the first image, too, lies between the canvas's pixels
constexpr double kNoise = 2.0;
constexpr double kCorners = 4.0;

// A continuous picture: Catmull-Rom's interpolation of a canvas, at any precision, which cv::remap does not have.
class Canvas {
 public:
  Canvas(const cv::Size& size, unsigned seed) {
    cv::Mat grey;
    cv::cvtColor(syntheticTissue(size + cv::Size(2 * kMargin, 2 * kMargin), seed), grey, cv::COLOR_BGR2GRAY);
    grey.convertTo(pixels_, CV_32F);
  }

  float at(double u, double v) const {
    u = std::clamp(u + kMargin + kOffset, 1.0, pixels_.cols - 3.0);
    v = std::clamp(v + kMargin + kOffset, 1.0, pixels_.rows - 3.0);
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const std::array<float, 4> right = weights(static_cast<float>(u - x)), down = weights(static_cast<float>(v - y));
    float sum = 0.0f;
    for (int j = 0; j < 4; ++j) {
      const float* row = pixels_[y + j - 1] + x - 1;
      sum += down[static_cast<std::size_t>(j)] *
             (right[0] * row[0] + right[1] * row[1] + right[2] * row[2] + right[3] * row[3]);
    }
    return sum;
  }

 private:
  static std::array<float, 4> weights(float t) {
    return {0.5f * t * (-1.0f + t * (2.0f - t)), 0.5f * (2.0f + t * t * (-5.0f + 3.0f * t)),
            0.5f * t * (1.0f + t * (4.0f - 3.0f * t)), 0.5f * t * t * (-1.0f + t)};
  }
  cv::Mat1f pixels_;
};

struct Patch {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;  // px
  bool holds(const Eigen::Vector2d& p) const { return (p - centre).squaredNorm() < radius * radius; }
};

cv::Mat1f draw(const cv::Size& size, const Canvas& plane, const Eigen::Matrix3d& back, const Canvas& other,
               const Eigen::Matrix3d& other_back, const Patch& patch) {
  cv::Mat1f image(size);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector2d pixel(u, v), there = geometry::apply(other_back, pixel);
      const Eigen::Vector2d here = geometry::apply(back, pixel);
      image(v, u) = patch.holds(there) ? other.at(there.x(), there.y()) : plane.at(here.x(), here.y());
    }
  }
  return image;
}

// Grown until it has that share of the gradient energy.
Patch patchOf(const cv::Size& size, const Canvas& plane, const Canvas& other, double share, std::mt19937& random) {
  Patch patch;
  if (!(share > 0.0)) return patch;
  std::uniform_real_distribution<double> unit(0.25, 0.75);
  patch.centre = Eigen::Vector2d(unit(random) * size.width, unit(random) * size.height);
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  for (;;) {
    patch.radius += 4.0;
    const cv::Mat1f image = draw(size, plane, identity, other, identity, patch);
    double inside = 0.0, all = 0.0;
    for (int v = 1; v + 1 < size.height; v += 2) {
      for (int u = 1; u + 1 < size.width; u += 2) {
        const double x = image(v, u + 1) - image(v, u - 1), y = image(v + 1, u) - image(v - 1, u);
        all += x * x + y * y;
        if (patch.holds({u, v})) inside += x * x + y * y;
      }
    }
    if (inside >= share * all) return patch;
  }
}

cv::Mat coloured(const cv::Mat1f& grey, std::mt19937& random) {
  cv::RNG rng(random());
  cv::Mat channels[3], image;
  const double gains[3] = {0.7, 0.9, 1.15};
  for (int c = 0; c < 3; ++c) {
    cv::Mat1f noise(grey.size());
    rng.fill(noise, cv::RNG::NORMAL, 0.0, kNoise);
    channels[c] = grey * gains[c] + noise;
  }
  cv::merge(channels, 3, image);
  image.convertTo(image, CV_8U);
  return image;
}

}  // namespace

Eigen::Matrix3d randomMotion(motion::Model model, const cv::Size& size, std::mt19937& random) {
  const geometry::Rectangle frame{0.0, 0.0, static_cast<double>(size.width), static_cast<double>(size.height)};
  motion::MotionField field = motion::fieldOf(displacedCorners(frame, kCorners, random), frame.centre());
  field.a.tail(8 - motion::parametersOf(model)).setZero();
  return motion::homographyOf(field);
}

MotionScene movingScene(const cv::Size& size, const std::vector<Eigen::Matrix3d>& motions, double foreign,
                        std::mt19937& random) {
  const Canvas plane(size, random()), other(size, random());
  const Patch patch = patchOf(size, plane, other, foreign, random);
  const Eigen::Matrix3d own = displaced(std::uniform_real_distribution<double>(3.0, 10.0)(random), random);
  MotionScene scene;
  Eigen::Matrix3d further = Eigen::Matrix3d::Identity();
  for (const Eigen::Matrix3d& g : motions) {
    const Eigen::Matrix3d other_g = further * g;
    scene.images.push_back(coloured(draw(size, plane, g.inverse(), other, other_g.inverse(), patch), random));
    scene.truth.push_back(g);
    further = own * further;
  }
  return scene;
}

double motionError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const cv::Size& size) {
  constexpr int kAlong = 8;
  double sum = 0.0;
  for (int j = 0; j <= kAlong; ++j) {
    for (int i = 0; i <= kAlong; ++i) {
      const Eigen::Vector2d p((size.width - 1.0) * i / kAlong, (size.height - 1.0) * j / kAlong);
      sum += (geometry::apply(g, p) - geometry::apply(truth, p)).squaredNorm();
    }
  }
  return std::sqrt(sum / ((kAlong + 1) * (kAlong + 1)));
}

}  // namespace laparoscope_servo::bench
