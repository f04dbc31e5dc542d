// The picture that a user looks at: the image with what the tracker makes of it.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo {

// A copy of `image` (8UC1 or 8UC3) as 8UC3 with the ROI as it was selected in blue, where it is now in red (thin while
// it is only searched for, absent when it is lost), the areas taken for occluded as filled blue squares, half
// transparent, in perspective, and a line of text: state, visible fraction, reason.
// With a lens the image is a raw one, and the edges are bent as it shows them.
cv::Mat drawOverlay(const cv::Mat& image, const tracking::TrackResult& result, const image::Lens* lens = nullptr);

}  // namespace laparoscope_servo
