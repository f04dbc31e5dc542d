// Which region would do, where the one that was wanted has too little texture or could not be held.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// A region near `wanted`, larger or moved, that `would_do` accepts: of those that differ least, in position and size.
// Regions are looked at in the order of that difference, as far as their texture is clear in a coarse image and hardly
// anything covers them; `would_do` is asked for a few. Empty when none of them would. `image`: CV_8UC1 or CV_8UC3;
// `covered`: CV_8UC1 of its size, not 0 where no region should lie; empty: it may lie anywhere. Regions are whole
// pixels, rectified ones with a lens (null: none).
std::optional<geometry::Rectangle> proposeRegion(const cv::Mat& image, const cv::Mat& covered,
                                                 const geometry::Rectangle& wanted, const image::Lens* lens,
                                                 const std::function<bool(const geometry::Rectangle&)>& would_do);

// The same, of regions that a tracker of this configuration would take, with texture that is clearly enough. Throws
// std::invalid_argument as RegionTracker::propose does.
std::optional<geometry::Rectangle> proposeRegion(const cv::Mat& image, const geometry::Rectangle& wanted,
                                                 const TrackerConfig& config,
                                                 const std::shared_ptr<const image::Lens>& lens);

}  // namespace laparoscope_servo::tracking
