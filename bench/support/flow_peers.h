// Motion between two images by OpenCV's optical flow and a robust fit.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/motion/motion_model.h"

namespace laparoscope_servo::bench {

struct FlowPeer {
  std::string name;
  // From the pixels of the first image (CV_8UC3) to those of the second; the identity where nothing was found.
  std::function<Eigen::Matrix3d(const cv::Mat&, const cv::Mat&)> motion;
};

// Pyramidal KLT of up to 500 corners, and DIS flow (fast) every 8 px; then the median shift, estimateAffine2D or
// findHomography, by RANSAC, or MAGSAC where OpenCV has it.
std::vector<FlowPeer> flowPeers(motion::Model model);

}  // namespace laparoscope_servo::bench
