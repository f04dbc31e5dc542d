// The image in which the offline tracker selects its region, for somebody who draws one.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "ros/playback/tracker_offline.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

class FirstImage {
 public:
  // Throws as trackOffline does where the first image cannot be used.
  explicit FirstImage(const OfflineOptions& options);
  // Reads it from a source that was opened for these options, and not read yet.
  FirstImage(const OfflineOptions& options, ImageSource& source);
  // Of an image that was read already, with the camera_info that holds for it.
  FirstImage(const OfflineOptions& options, const SourceImage& image);

  // 8UC1 or 8UC3, rectified where the tracker rectifies; at most `side` px wide and high.
  cv::Mat picture(int side) const;
  cv::Size size() const { return snapshot_.image.size(); }  // px, of the image itself
  std::size_t frame() const { return frame_; }              // of the input, from 0

  // Why the tracker would not take this region, in px of the image; empty: it would.
  std::string refusal(const geometry::Rectangle& roi) const;
  // A region near a refused one that the tracker would take; empty: there is none.
  std::optional<geometry::Rectangle> proposal(const geometry::Rectangle& roi) const;
  // A square at the image's centre, or what the tracker would take near it; empty: there is none.
  std::optional<geometry::Rectangle> suggestion() const;

 private:
  TrackerParameters parameters_;
  Snapshot snapshot_;
  std::size_t frame_ = 0;
};

}  // namespace laparoscope_servo
