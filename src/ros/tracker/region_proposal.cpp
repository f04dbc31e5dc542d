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

sensor_msgs::RegionOfInterest proposalMessage(const std::optional<geometry::Rectangle>& region) {
  sensor_msgs::RegionOfInterest message;
  if (!region || region->x < 0.0 || region->y < 0.0) return message;
  message.x_offset = static_cast<std::uint32_t>(region->x);
  message.y_offset = static_cast<std::uint32_t>(region->y);
  message.width = static_cast<std::uint32_t>(region->width);
  message.height = static_cast<std::uint32_t>(region->height);
  return message;
}

}  // namespace laparoscope_servo
