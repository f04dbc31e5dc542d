// Views that a surgeon has stored under names: images, each with a region of interest (ROI), and which of them can be
// reached from which. One leads to another when the ROI of the other is found in its image, by the search that finds a
// lost ROI, with all of that search's tests. No clock, not thread-safe.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

struct View {
  cv::Mat image;            // CV_8UC1 or CV_8UC3, not shared
  geometry::Rectangle roi;  // px, whole; with a lens rectified ones
};

// Where a ROI is now, as an upright rectangle of whole pixels: about the same middle, of the same area, as wide to high
// as what bounds it; then cut to `image`, the pixels there are. Throws std::invalid_argument when nothing is left.
geometry::Rectangle uprightRoi(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const cv::Rect& image);

class ViewStore {
 public:
  // The names of the views to go through, the last one that was asked for; empty when there is no way: `why` says why.
  struct Route {
    std::vector<std::string> names;
    std::string why;
  };

  // At most `capacity` views. With a lens the images are raw, ROIs in rectified pixels. Throws std::invalid_argument
  // for a configuration that validate() refuses, and for a capacity below 1.
  explicit ViewStore(const TrackerConfig& config, int capacity = 32, std::shared_ptr<const image::Lens> lens = nullptr);

  // Copies the view, and compares it with every other. Replaces one of the same name. Throws std::invalid_argument,
  // saying what was expected, when the name is empty or longer than 64 bytes, no place is left, or a tracker would not
  // take the ROI; the store then stays as it was.
  void store(const std::string& name, const cv::Mat& image, const geometry::Rectangle& roi);

  std::vector<std::string> names() const;  // in alphabetical order
  // Throws std::invalid_argument that names the views there are when this is none of them; so do all that follow.
  const View& get(const std::string& name) const;

  // The ROI of `to` was found in the image of `from`.
  bool leads(const std::string& from, const std::string& to) const;
  // Whether the view's ROI is found in an image (CV_8UC1 or CV_8UC3).
  bool isSeen(const std::string& name, const cv::Mat& image) const;

  // The least number of views, both ends with them, each of which leads to the next; empty when there is no way.
  std::vector<std::string> path(const std::string& from, const std::string& to) const;
  // The same, from what `image` shows now to view `to`, without a step for the image itself. Looks for the views in the
  // image in the order of their distance from `to`, so that `to` itself, when it is seen, costs one search.
  Route route(const cv::Mat& image, const std::string& to) const;

 private:
  struct Entry {
    View view;
    std::map<std::string, bool> leads_to;
  };
  // In the order of distance, `to` first: the next view on the way from each view that leads there.
  std::vector<std::pair<std::string, std::string>> waysTo(const std::string& to) const;
  const Entry& entry(const std::string& name) const;

  TrackerConfig config_;
  int capacity_;
  std::shared_ptr<const image::Lens> lens_;
  std::map<std::string, Entry> entries_;
};

}  // namespace laparoscope_servo::tracking
