// Stores named views (images with a region of interest, ROI), and which view can be reached from which. View A leads to
// view B if the search for a lost ROI finds the ROI of B in the image of A, with all of that search's tests. Keeps no
// clock, is not thread-safe.
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
  cv::Mat image;            // CV_8UC1 or CV_8UC3, a copy of its own
  geometry::Rectangle roi;  // px, whole; with a lens rectified ones
};

// An upright rectangle of whole pixels for a ROI seen at `g`: with the area of the ROI there, and centre and aspect
// ratio of its bounding box; then cut to the bounds `image`. Throws std::invalid_argument when nothing is left.
geometry::Rectangle uprightRoi(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const cv::Rect& image);

class ViewStore {
 public:
  // The names of the views to go through, ending with the requested one. Empty if there is no way; `why` then holds the
  // reason.
  struct Route {
    std::vector<std::string> names;
    std::string why;
  };

  // At most `capacity` views. With a lens the images are raw, ROIs in rectified pixels. Throws std::invalid_argument
  // for a configuration that validate() refuses, and for a capacity below 1.
  explicit ViewStore(const TrackerConfig& config, int capacity = 32, std::shared_ptr<const image::Lens> lens = nullptr);

  // Copies the view and compares it with every other one. Replaces a view of the same name. Throws
  // std::invalid_argument, saying what was expected, when the name is empty or longer than 64 bytes, no place is left,
  // or a tracker would not take the ROI; the store then stays as it was.
  void store(const std::string& name, const cv::Mat& image, const geometry::Rectangle& roi);

  std::vector<std::string> names() const;  // in alphabetical order
  // This and all functions below throw std::invalid_argument for an unknown name; its text lists the stored names.
  const View& get(const std::string& name) const;

  // Whether the ROI of `to` was found in the image of `from`.
  bool leads(const std::string& from, const std::string& to) const;
  // Whether the view's ROI is found in an image (CV_8UC1 or CV_8UC3).
  bool isSeen(const std::string& name, const cv::Mat& image) const;

  // The shortest sequence of views, `from` and `to` included, each of which leads to the next; empty if there is none.
  std::vector<std::string> path(const std::string& from, const std::string& to) const;
  // The shortest sequence of views from the present `image` to view `to`, without an entry for the image itself.
  // Searches the image for the views in the order of their distance from `to`, so that a visible `to` costs only one
  // search.
  Route route(const cv::Mat& image, const std::string& to) const;

 private:
  struct Entry {
    View view;
    std::map<std::string, bool> leads_to;
  };
  // Each view from which `to` can be reached with the next view on the way, in the order of distance, `to` first.
  std::vector<std::pair<std::string, std::string>> waysTo(const std::string& to) const;
  const Entry& entry(const std::string& name) const;

  TrackerConfig config_;
  int capacity_;
  std::shared_ptr<const image::Lens> lens_;
  std::map<std::string, Entry> entries_;
};

}  // namespace laparoscope_servo::tracking
