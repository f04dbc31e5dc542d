#include "ros/tracker/region_proposal.h"

#include <stdexcept>

#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {

std::optional<geometry::Rectangle> regionThatWouldDo(const tracking::RegionTracker& tracker, const cv::Mat& image,
                                                     const geometry::Rectangle& roi) {
  try {
    return tracker.propose(image, roi);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

std::string proposalText(const std::optional<geometry::Rectangle>& region) {
  return region ? "; " + roiText(*region) + " would do" : "";
}

}  // namespace laparoscope_servo
