// In words, which region would do where another one was refused or could not be held.
#pragma once

#include <sensor_msgs/RegionOfInterest.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo {

// See RegionTracker::propose; empty, too, where the ROI or the image is none.
std::optional<geometry::Rectangle> regionThatWouldDo(const tracking::RegionTracker& tracker, const cv::Mat& image,
                                                     const geometry::Rectangle& roi);

// To be put behind a reason: "; 12,34,100,90 would do". Empty when there is no region.
std::string proposalText(const std::optional<geometry::Rectangle>& region);

// Of width 0 when there is no region, or one that begins at negative pixels, as rectified ones may: the message cannot
// say these.
sensor_msgs::RegionOfInterest proposalMessage(const std::optional<geometry::Rectangle>& region);

}  // namespace laparoscope_servo
