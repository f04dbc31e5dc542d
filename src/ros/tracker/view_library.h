// The views of one camera that are stored while the tracker runs. Not thread-safe.
#pragma once

#include <laparoscope_servo/StoredViewInfo.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/tracking/view_store.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/tracker_parameters.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

constexpr int kThumbnailSide = 160;  // px, largest side

class ViewLibrary {
 public:
  explicit ViewLibrary(const TrackerParameters& parameters);

  // Stores the snapshot's image and region. Returns a text with what was stored, and its links to other views. Throws
  // std::invalid_argument if it cannot be stored.
  std::string store(const std::string& name, const Snapshot& snapshot);
  // The way from the snapshot to a view. Throws std::invalid_argument if there is none, or no such view.
  RecallRoute route(const std::string& name, const Snapshot& snapshot);

  // In alphabetical order.
  std::vector<StoredViewInfo> list(bool thumbnails);

  const tracking::ViewStore& views() const { return store_; }

 private:
  void followCamera(const Snapshot& snapshot);

  TrackerParameters parameters_;
  tracking::ViewStore store_;
  std::map<std::string, ros::Time> stamps_;
  std::optional<geometry::PinholeCamera> camera_;
  std::shared_ptr<const image::Lens> lens_;
  Preview thumbnail_{kThumbnailSide};
  std::string forgotten_;  // why stored views were deleted
};

// "'a', 'b'": the names of a way.
std::string routeText(const RecallRoute& route);

}  // namespace laparoscope_servo
