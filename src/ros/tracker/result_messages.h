// Messages with the results of one image. All have the image's header.
#pragma once

#include <geometry_msgs/PolygonStamped.h>
#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/TaskError.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>

#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// While no ROI is selected: g and h are the identity, the corners 0. Without usable intrinsics h is the identity.
Homography homographyMessage(const Processed& processed);

// Invalid, with zeros except for the stamps, unless the state is TRACKING, there are usable intrinsics and all numbers
// are finite.
TaskError taskErrorMessage(const Processed& processed);

AreaSelection areaSelectionMessage(const Processed& processed);

// The current corners, px, in the order of Homography.msg; without points while no ROI is selected or lost.
geometry_msgs::PolygonStamped roiMessage(const Processed& processed);

// `image` 8UC1 (mono8) or 8UC3 (bgr8).
sensor_msgs::ImagePtr imageMessage(const std_msgs::Header& header, const cv::Mat& image);

}  // namespace laparoscope_servo
