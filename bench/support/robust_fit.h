// The robust fit that OpenCV's peers take: MAGSAC where this OpenCV has it, else RANSAC.
#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core/version.hpp>

namespace laparoscope_servo::bench {

// USAC came with OpenCV 4.5.1.
#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 + CV_VERSION_REVISION >= 40501
constexpr int kRobustFit = cv::USAC_MAGSAC;
constexpr char kRobustFitName[] = "magsac";
#else
constexpr int kRobustFit = cv::RANSAC;
constexpr char kRobustFitName[] = "ransac";
#endif

}  // namespace laparoscope_servo::bench
