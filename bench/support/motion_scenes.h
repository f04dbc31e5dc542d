// Pictures of a plane that moves by a model, with another part that moves otherwise; what is true is known exactly.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "laparoscope_servo/motion/motion_model.h"

namespace laparoscope_servo::bench {

struct MotionScene {
  std::vector<cv::Mat> images;         // CV_8UC3
  std::vector<Eigen::Matrix3d> truth;  // from the first image to each, pixels
};

// A motion of the model from image to image: corners of the image move by a few px (standard deviation 4).
Eigen::Matrix3d randomMotion(motion::Model model, const cv::Size& size, std::mt19937& random);

// The same scene after each of the motions from the first image, which is the identity; noise of two grey levels. A
// patch that moves 3 to 10 px further by image, in a direction of its own, has the share `foreign` of the gradient
// energy of the first image.
MotionScene movingScene(const cv::Size& size, const std::vector<Eigen::Matrix3d>& motions, double foreign,
                        std::mt19937& random);

// px, root mean square over the image of how far the motion is from what is true.
double motionError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const cv::Size& size);

}  // namespace laparoscope_servo::bench
