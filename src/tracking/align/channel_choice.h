// Which mixture of an image's colours is tracked, or which of them: one that shows the region and does not clip.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// `patch`: the region in the reference, CV_8UC1 or CV_8UC3. saturation: grey levels, 1 to 256, from which a channel
// shows nothing.
//   kLuma       as it is
//   kStrongest  the mixture whose gradient is strongest for its noise, of those of the channels that hold the most of
//   it
//               together: what clips in any of them does not count. Among what is nearly as good, that which keeps most
//               of it when the lamp becomes brighter
//   kColour     those of the channels that hold the most gradient together, with what clips in any of them left out
image::Channels chosenChannels(TrackedChannels wanted, const cv::Mat& patch, int saturation);

// Whether what is tracked depends on blue, green, red.
std::array<bool, 3> coloursIn(const image::Channels& tracked);

}  // namespace laparoscope_servo::tracking
