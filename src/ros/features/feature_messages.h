// The message with all features of one image.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <std_msgs/Header.h>

#include <opencv2/core.hpp>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo {

// `size`: of the image.
TrackedFeatures featuresMessage(const std_msgs::Header& header, const cv::Size& size,
                                const features::TrackedFeatures& tracked);

}  // namespace laparoscope_servo
