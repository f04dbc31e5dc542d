// The message with all features of one image.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

#include <opencv2/core.hpp>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo {

// `size`: of the image. `selected`: stamp of the image of their selection; zero: there was none.
TrackedFeatures featuresMessage(const std_msgs::Header& header, const cv::Size& size,
                                const features::TrackedFeatures& tracked, const ros::Time& selected = ros::Time());

}  // namespace laparoscope_servo
