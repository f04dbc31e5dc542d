// Draws tracked features into the image, for a user.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo {

// A copy of `image` (8UC1 or 8UC3) as 8UC3 with the outline of each feature and its id: red where it was seen, thin and
// yellow where it is expected while it is searched for, absent when it is lost; on it the sites at which edges were
// searched, a green dot the larger its weight is, a white cross for a weight of 0; and a line of text: state, how many
// are tracked, reason. A motion: its field as arrows, five times as long as it is, over blue where the image does not
// follow it, by the tracker's `mask`.
cv::Mat drawFeatures(const cv::Mat& image, const features::TrackedFeatures& tracked, const cv::Mat& mask = cv::Mat());

}  // namespace laparoscope_servo
