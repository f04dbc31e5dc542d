// A thing with a closed outline that moves by a homography in front of a background that rests, and what its tracker is
// given to find it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "laparoscope_servo/features/feature_selection.h"
#include "laparoscope_servo/geometry/homography.h"
#include "synthetic_edges.h"
#include "synthetic_tissue.h"

namespace laparoscope_servo::test_support {

class ContourScene {
 public:
  struct Look {
    double inside = 140.0;  // grey levels
    double texture = 0.0;   // standard deviation inside
    double outside = 90.0;
    double background = 0.0;  // standard deviation of the texture outside
    double noise = 2.0;
    double speed = 1.0;     // times 5 px an image at the most
    double exposure = 0.0;  // share of the time between two images over which the motion blurs
    double bend = 0.0;      // px, by which the thing deforms beside the homography
    unsigned seed = 0;      // of textures, motion and bending
  };
  using Cover = std::function<void(cv::Mat1f&)>;  // paints over a picture

  explicit ContourScene(const Look& look)
      : look_(look),
        inside_(test::texture(kSize, look.inside, look.texture, 3.0, 2 * look.seed + 11)),
        outside_(test::texture(kSize, look.outside, look.background, 3.0, 2 * look.seed + 12)),
        shape_(test::coverage(kSize, [](const Eigen::Vector2d& p) {
          const Eigen::Vector2d d = p - kCentre;
          return d.norm() < radius(std::atan2(d.y(), d.x()));
        })) {
    cv::RNG random(look.seed + 100);
    for (double& phase : phases_) phase = look.seed == 0 ? 0.0 : random.uniform(0.0, 2.0 * M_PI);
  }

  static double radius(double angle) { return 62.0 + 9.0 * std::cos(2.0 * angle) + 5.0 * std::sin(3.0 * angle); }
  static Eigen::Vector2d at(double angle) {
    return kCentre + radius(angle) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }

  // Shift, turn, scale and perspective, from the image 0 to `k`.
  Eigen::Matrix3d motion(double k) const {
    const double t = 0.09 * look_.speed * k;
    const auto swing = [&](double rate, std::size_t i) {
      return std::sin(rate * t + phases_[i]) - std::sin(phases_[i]);
    };
    const geometry::Quadrilateral box = geometry::Rectangle{85.0, 50.0, 150.0, 140.0}.corners();
    geometry::Quadrilateral moved = box;
    const double turn = 0.12 * swing(0.7, 0), scale = 1.0 + 0.08 * swing(0.9, 1);
    for (int c = 0; c < 4; ++c) {
      const std::size_t i = static_cast<std::size_t>(c);
      const Eigen::Vector2d d = box[i] - kCentre;
      moved[i] = kCentre +
                 scale * Eigen::Vector2d(std::cos(turn) * d.x() - std::sin(turn) * d.y(),
                                         std::sin(turn) * d.x() + std::cos(turn) * d.y()) +
                 Eigen::Vector2d(40.0 * swing(1.0, 2), 18.0 * swing(1.3, 3)) +
                 2.0 * swing(0.8, 4) * Eigen::Vector2d(std::cos(1.0 * c), std::sin(2.0 * c));
    }
    return geometry::fromCorners(box, moved);
  }

  // Where a point of the image 0 is in the image `k`, px.
  Eigen::Vector2d place(const Eigen::Vector2d& p, double k) const {
    return geometry::apply(motion(k), p + bending(p, k));
  }

  // CV_8UC1, of the time `k` in images; `cover` is painted over it before blur and noise, `seed` is of the noise.
  cv::Mat image(double k, unsigned seed, const Cover& cover = nullptr) const {
    const int moments = look_.exposure > 0.0 ? 5 : 1;
    cv::Mat1f picture = cv::Mat1f::zeros(kSize);
    for (int m = 0; m < moments; ++m) {
      picture += sharp(k + look_.exposure * (m - 0.5 * (moments - 1)) / moments) / static_cast<float>(moments);
    }
    if (cover) cover(picture);
    cv::GaussianBlur(picture, picture, cv::Size(), 0.9);
    cv::Mat1f grain(kSize);
    cv::RNG(seed + 1000 * look_.seed).fill(grain, cv::RNG::NORMAL, 0.0, look_.noise);
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

  // px, mean distance of the outline's points under H from where they are in the image `k`; where the thing bends, from
  // where the homography puts them that fits its points best, those inside and those of the outline.
  double error(const Eigen::VectorXd& parameters, double k) const {
    Eigen::Matrix3d h;
    h << parameters[0], parameters[1], parameters[2], parameters[3], parameters[4], parameters[5], parameters[6],
        parameters[7], 1.0;
    const Eigen::Matrix3d truth = look_.bend > 0.0 ? fitted(k) : motion(k);
    constexpr int kPoints = 36;
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector2d p = at(2.0 * M_PI * i / kPoints);
      sum += (geometry::apply(h, p) - geometry::apply(truth, p)).norm();
    }
    return sum / kPoints;
  }

  static inline const cv::Size kSize{320, 240};
  static inline const Eigen::Vector2d kCentre{160.0, 120.0};

 private:
  Eigen::Matrix3d fitted(double k) const {
    std::vector<cv::Point2d> from, to;
    for (const double scale : {0.3, 0.55, 0.7, 0.85, 1.0}) {  // rings of about equal areas
      for (double angle = 0.0; angle < 2.0 * M_PI; angle += M_PI / 18.0) {
        const Eigen::Vector2d p = kCentre + scale * (at(angle) - kCentre), q = place(p, k);
        from.emplace_back(p.x(), p.y());
        to.emplace_back(q.x(), q.y());
      }
    }
    const cv::Matx33d best = cv::findHomography(from, to, 0);
    Eigen::Matrix3d g;
    g << best(0, 0), best(0, 1), best(0, 2), best(1, 0), best(1, 1), best(1, 2), best(2, 0), best(2, 1), best(2, 2);
    return g;
  }

  // px of the image 0, waves as long as the thing is wide.
  Eigen::Vector2d bending(const Eigen::Vector2d& p, double k) const {
    if (!(look_.bend > 0.0)) return Eigen::Vector2d::Zero();
    const double t = std::sin(0.09 * look_.speed * k);
    return look_.bend * t * Eigen::Vector2d(std::sin(0.05 * p.y() + phases_[0]), std::sin(0.05 * p.x() + phases_[1]));
  }

  cv::Mat1f sharp(double k) const {
    const Eigen::Matrix3d g = motion(k);
    cv::Mat1f shape, inside;
    if (look_.bend > 0.0) {
      cv::Mat2f from(kSize);
      const Eigen::Matrix3d back = g.inverse();
      from.forEach([&](cv::Vec2f& to, const int* at) {
        const Eigen::Vector2d p = geometry::apply(back, Eigen::Vector2d(at[1], at[0]));
        const Eigen::Vector2d q = p - bending(p - bending(p, k), k);
        to = cv::Vec2f(static_cast<float>(q.x()), static_cast<float>(q.y()));
      });
      cv::remap(shape_, shape, from, cv::noArray(), cv::INTER_LINEAR);
      cv::remap(inside_, inside, from, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    } else {
      cv::warpPerspective(shape_, shape, test::toMatx(g), kSize, cv::INTER_LINEAR);
      cv::warpPerspective(inside_, inside, test::toMatx(g), kSize, cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    }
    return cv::Mat1f(inside.mul(shape) + outside_.mul(1.0f - shape));
  }

  Look look_;
  std::array<double, 5> phases_{};
  cv::Mat1f inside_, outside_, shape_;
};

}  // namespace laparoscope_servo::test_support
