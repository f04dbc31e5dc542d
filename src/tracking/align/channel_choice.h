// Chooses the tracked channel (a weighted sum of the colours) or channels: those with the strongest gradients in the
// region that do not clip.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// `patch`: the region in the reference, CV_8UC1 or CV_8UC3. saturation: grey levels, 1 to 256, from which a channel
// shows nothing.
//   kLuma       luma
//   kStrongest  the weighted sum with the strongest gradient for its noise. Channels that clip in a pixel do not count
//               there. Among sums that are nearly as strong, the one that keeps most of its gradient under a brighter
//               lamp
//   kColour     the channels that have the strongest gradients together, without those that clip
image::Channels chosenChannels(TrackedChannels wanted, const cv::Mat& patch, int saturation);

// The mixture for light in which others clip: that of the set of channels with the strongest gradient for its noise
// under a lamp 1.5 times as bright. Empty where that set is the one of `usual`, or where `wanted` is not kStrongest.
// `patch`: CV_8UC3.
std::optional<image::Channels> brightChannels(TrackedChannels wanted, const cv::Mat& patch, int saturation,
                                              const image::Channels& usual);

// Whether the tracked channels depend on blue, green, red.
std::array<bool, 3> coloursIn(const image::Channels& tracked);

}  // namespace laparoscope_servo::tracking
