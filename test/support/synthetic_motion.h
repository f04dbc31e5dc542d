// Pictures for tests of dominant motion: a texture that moves by a model, with a part of it that moves otherwise.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/motion/motion_model.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::test {

constexpr int kMotionWidth = 320, kMotionHeight = 240;

inline geometry::Rectangle motionFrame() {
  return {0.0, 0.0, kMotionWidth, kMotionHeight};
}

// A usual motion from an image to the next, of this model. A shift alone is by whole pixels: between them OpenCV's
// bicubic warp is off by some hundredths of a pixel, the same all over the image.
inline motion::MotionField usualMotion(motion::Model model = motion::Model::kQuadratic) {
  motion::MotionField field;
  field.centre = motionFrame().centre();
  field.a << 3.0, -2.0, 0.012, 0.008, -0.010, 0.006, 2.5e-5, -2e-5;
  field.a.tail(8 - motion::parametersOf(model)).setZero();
  return field;
}

// px, the largest error of g over the image's corners.
inline double motionError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth) {
  return geometry::cornerDistance(g, truth, motionFrame());
}

// Image `k` of a scene: tissue after k times the motion, with noise of two grey levels.
inline cv::Mat movingTissue(int k, const motion::MotionField& field, unsigned seed = 3, double gain = 1.0,
                            double offset = 0.0) {
  motion::MotionField all = field;
  all.a *= k;
  const cv::Mat scene = tissue({kMotionWidth, kMotionHeight}, seed);
  return view(scene, motion::homographyOf(all), gain, offset, 2.0, static_cast<unsigned>(100 + k));
}

// Another texture over the box, shifted by k times `step`, which is px.
inline void cover(cv::Mat& image, int k, const cv::Rect& box, const Eigen::Vector2d& step, unsigned seed = 50) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() = k * step;
  const cv::Mat other = view(tissue(image.size(), seed), g, 1.0, 0.0, 2.0, static_cast<unsigned>(200 + k));
  const cv::Rect there =
      (box + cv::Point(static_cast<int>(k * step.x()), static_cast<int>(k * step.y()))) & cv::Rect({}, image.size());
  other(there).copyTo(image(there));
}

}  // namespace laparoscope_servo::test
