// What services ask of the next image of the region tracker.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "laparoscope_servo/geometry/homography.h"
#include "ros/common/image_request.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

struct WantSnapshot {};  // requests a snapshot of the next image

// A ROI to select in the next image, a snapshot, or a way to follow from the next image on.
using TrackerQuestion = std::variant<geometry::Rectangle, WantSnapshot, RecallRoute>;

struct TrackerAnswer {
  bool success = false;
  std::string message;
  std::shared_ptr<const Snapshot> snapshot = nullptr;   // to WantSnapshot
  std::shared_ptr<const Snapshot> reference = nullptr;  // to WantSnapshot, see TrackerSession::reference
};

using TrackerRequest = ImageRequest<TrackerQuestion, TrackerAnswer>;

}  // namespace laparoscope_servo
