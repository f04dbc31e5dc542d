// Draws the tracker's result into the image, for a user.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/track_result.h"

namespace laparoscope_servo {

// A copy of `image` (8UC1 or 8UC3) as 8UC3 with the ROI as it was selected in blue, where it is now in red (thin while
// it is only searched for, absent when it is lost), the occluded areas as filled blue squares, half transparent, in
// perspective, and a line of text: state, visible fraction, reason. With a lens the image is raw, and edges are drawn
// bent.
cv::Mat drawOverlay(const cv::Mat& image, const tracking::TrackResult& result, const image::Lens* lens = nullptr);

// A copy of `image` (8UC1 or 8UC3) as 8UC3, to draw on.
cv::Mat canvasOf(const cv::Mat& image);
// White on black, legible on any picture; `left_bottom`: of the first letter, px; `size`: 1 is 30 px high.
void drawText(cv::Mat& canvas, const std::string& text, const cv::Point& left_bottom, double size);
// A line of text in the upper left corner.
void drawCaption(cv::Mat& canvas, const std::string& text);

}  // namespace laparoscope_servo
