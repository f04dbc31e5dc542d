// Draws the tracker's result into the image, for a user.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo {

// A copy of `image` (8UC1 or 8UC3) as 8UC3 with the ROI as it was selected in blue, where it is now in red (thin while
// it is only searched for, absent when it is lost), the occluded areas as filled blue squares, half transparent, in
// perspective, and a line of text: state, visible fraction, reason. With a lens the image is raw, and edges are drawn
// bent.
cv::Mat drawOverlay(const cv::Mat& image, const tracking::TrackResult& result, const image::Lens* lens = nullptr);

}  // namespace laparoscope_servo
