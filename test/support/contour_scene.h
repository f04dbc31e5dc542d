// A thing with a closed outline that moves by a homography in front of a background that rests, and what its tracker is
// given to find it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "laparoscope_servo/features/feature_selection.h"
#include "laparoscope_servo/geometry/homography.h"
#include "synthetic_edges.h"

namespace laparoscope_servo::test_support {

class ContourScene {
 public:
  struct Look {
    double inside = 140.0;  // grey levels
    double texture = 0.0;   // standard deviation inside
    double outside = 90.0;
    double background = 0.0;  // standard deviation of the texture outside
    double noise = 2.0;
  };

  explicit ContourScene(const Look& look)
      : look_(look),
        inside_(test::texture(kSize, look.inside, look.texture, 3.0, 11)),
        outside_(test::texture(kSize, look.outside, look.background, 3.0, 12)),
        shape_(test::coverage(kSize, [](const Eigen::Vector2d& p) {
          const Eigen::Vector2d d = p - kCentre;
          return d.norm() < radius(std::atan2(d.y(), d.x()));
        })) {}

  static double radius(double angle) { return 62.0 + 9.0 * std::cos(2.0 * angle) + 5.0 * std::sin(3.0 * angle); }
  static Eigen::Vector2d at(double angle) {
    return kCentre + radius(angle) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }

  // Shift, turn, scale and perspective; about 5 px per image at the most.
  static Eigen::Matrix3d motion(int k) {
    const double t = 0.09 * k;
    const geometry::Quadrilateral box = geometry::Rectangle{85.0, 50.0, 150.0, 140.0}.corners();
    geometry::Quadrilateral moved = box;
    const double turn = 0.12 * std::sin(0.7 * t), scale = 1.0 + 0.08 * std::sin(0.9 * t);
    for (int c = 0; c < 4; ++c) {
      const std::size_t i = static_cast<std::size_t>(c);
      const Eigen::Vector2d d = box[i] - kCentre;
      moved[i] = kCentre +
                 scale * Eigen::Vector2d(std::cos(turn) * d.x() - std::sin(turn) * d.y(),
                                         std::sin(turn) * d.x() + std::cos(turn) * d.y()) +
                 Eigen::Vector2d(40.0 * std::sin(t), 18.0 * std::sin(1.3 * t)) +
                 2.0 * std::sin(0.8 * t) * Eigen::Vector2d(std::cos(1.0 * c), std::sin(2.0 * c));
    }
    return geometry::fromCorners(box, moved);
  }

  // CV_8UC1; `cover` is painted over it before blur and noise, `seed` is of the noise.
  cv::Mat image(const Eigen::Matrix3d& g, unsigned seed, const std::function<void(cv::Mat1f&)>& cover = nullptr) const {
    cv::Matx33d m;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) m(r, c) = g(r, c);
    }
    cv::Mat1f shape, inside;
    cv::warpPerspective(shape_, shape, m, kSize, cv::INTER_LINEAR);
    cv::warpPerspective(inside_, inside, m, kSize, cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    cv::Mat1f picture = inside.mul(shape) + outside_.mul(1.0f - shape);
    if (cover) cover(picture);
    cv::GaussianBlur(picture, picture, cv::Size(), 0.9);
    cv::Mat1f grain(kSize);
    cv::RNG(seed).fill(grain, cv::RNG::NORMAL, 0.0, look_.noise);
    cv::Mat result;
    cv::Mat(picture + grain).convertTo(result, CV_8UC1);
    return result;
  }

  // Given by hand: off by up to `error` px.
  static features::FeatureSelection selection(double error = 1.0) {
    features::SelectedFeature selected;
    selected.id = "thing";
    selected.kind = features::FeatureKind::kSpline;
    selected.closed = true;
    for (int k = 0; k < 16; ++k) {
      const double angle = 2.0 * M_PI * k / 16.0;
      selected.points.push_back(at(angle) + error * Eigen::Vector2d(std::sin(5.0 * k), std::cos(3.0 * k)));
    }
    return {selected};
  }

  // px, mean distance of the contour's points under H from where they are.
  static double error(const Eigen::VectorXd& parameters, const Eigen::Matrix3d& g) {
    Eigen::Matrix3d h;
    h << parameters[0], parameters[1], parameters[2], parameters[3], parameters[4], parameters[5], parameters[6],
        parameters[7], 1.0;
    double sum = 0.0;
    for (int k = 0; k < 36; ++k) {
      const Eigen::Vector2d p = at(2.0 * M_PI * k / 36.0);
      sum += (geometry::apply(h, p) - geometry::apply(g, p)).norm();
    }
    return sum / 36.0;
  }

  static inline const cv::Size kSize{320, 240};
  static inline const Eigen::Vector2d kCentre{160.0, 120.0};

 private:
  Look look_;
  cv::Mat1f inside_, outside_, shape_;
};

}  // namespace laparoscope_servo::test_support
