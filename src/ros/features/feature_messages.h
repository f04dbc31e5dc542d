// The message with all features of one image.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo {

// `selected`: stamp of the image of their selection; zero: there was none.
TrackedFeatures featuresMessage(const std_msgs::Header& header, const features::TrackedFeatures& tracked,
                                const ros::Time& selected = ros::Time());

}  // namespace laparoscope_servo
