#include "ros/tracker/result_messages.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "laparoscope_servo/servo/task_function.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

static_assert(Homography::IDLE == static_cast<int>(tracking::State::kIdle));
static_assert(Homography::TRACKING == static_cast<int>(tracking::State::kTracking));
static_assert(Homography::SEARCHING == static_cast<int>(tracking::State::kSearching));
static_assert(AreaSelection::COLOUR == static_cast<int>(tracking::AreaCause::kColour));
static_assert(AreaSelection::STRUCTURE == static_cast<int>(tracking::AreaCause::kStructure));
static_assert(AreaSelection::HIGHLIGHT == static_cast<int>(tracking::AreaCause::kHighlight));
static_assert(AreaSelection::BORDER == static_cast<int>(tracking::AreaCause::kBorder));
static_assert(Homography::LOST == static_cast<int>(tracking::State::kLost));

template <class Array>
void setRowMajor(const Eigen::Matrix3d& matrix, Array& array) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) array[3 * row + column] = matrix(row, column);
  }
}

geometry::Quadrilateral currentCorners(const tracking::TrackResult& result) {
  return geometry::apply(result.g, result.roi.corners());
}

bool hasRoi(const tracking::TrackResult& result) {
  return result.state != tracking::State::kIdle;
}

}  // namespace

Homography homographyMessage(const Processed& processed) {
  const tracking::TrackResult& result = processed.result;
  Homography message;
  message.header = processed.header;
  message.state = static_cast<std::uint8_t>(result.state);
  message.has_intrinsics = static_cast<std::uint8_t>(processed.camera.has_value());
  setRowMajor(result.g, message.g);
  // H = K^-1 G K
  setRowMajor(
      processed.camera ? geometry::normalisedFromPixels(result.g, *processed.camera) : Eigen::Matrix3d::Identity(),
      message.h);
  message.processing_time = processed.processing_time;
  if (!hasRoi(result)) return message;
  message.reference_stamp = processed.reference_stamp;
  const geometry::Quadrilateral corners = currentCorners(result);
  for (int k = 0; k < 4; ++k) {
    message.corners[2 * k] = corners[k].x();
    message.corners[2 * k + 1] = corners[k].y();
  }
  message.visible_fraction = result.visible_fraction;
  message.zncc = result.zncc;
  message.corner_error = result.corner_error;
  message.centre_error = result.centre_error;
  message.iterations = static_cast<std::uint16_t>(
      std::clamp(result.iterations, 0, static_cast<int>(std::numeric_limits<std::uint16_t>::max())));
  return message;
}

TaskError taskErrorMessage(const Processed& processed) {
  TaskError message;
  message.header = processed.header;
  message.reference_stamp = processed.reference_stamp;
  const tracking::TrackResult& result = processed.result;
  if (result.state != tracking::State::kTracking || !processed.camera) return message;
  servo::TaskError error;
  try {
    error =
        servo::taskError(geometry::normalisedFromPixels(result.g, *processed.camera), result.roi, *processed.camera);
  } catch (const std::invalid_argument&) {
    return message;  // an estimate that corresponds to no camera motion must not move the robot
  }
  if (!servo::isFinite(error)) return message;
  message.valid = true;
  message.e_v = vectorMessage(error.e_v);
  message.e_w = vectorMessage(error.e_w);
  message.m_star = vectorMessage(error.m_star);
  message.x = error.x;
  message.y = error.y;
  message.log_depth = error.log_depth;
  message.alpha = error.alpha;
  message.desired_x = error.desired_x;
  message.desired_y = error.desired_y;
  message.desired_log_depth = error.desired_log_depth;
  message.desired_alpha = error.desired_alpha;
  message.visible_fraction = result.visible_fraction;
  message.corner_error = result.corner_scatter;
  return message;
}

AreaSelection areaSelectionMessage(const Processed& processed) {
  const tracking::AreaReport& areas = processed.result.areas;
  AreaSelection message;
  message.header = processed.header;
  message.rows = static_cast<std::uint16_t>(areas.rows);
  message.columns = static_cast<std::uint16_t>(areas.columns);
  message.distance = areas.distance;
  message.occluded.assign(areas.occluded.begin(), areas.occluded.end());
  for (const tracking::AreaCause cause : areas.cause) message.cause.push_back(static_cast<std::uint8_t>(cause));
  return message;
}

geometry_msgs::PolygonStamped roiMessage(const Processed& processed) {
  geometry_msgs::PolygonStamped message;
  message.header = processed.header;
  const tracking::TrackResult& result = processed.result;
  if (!hasRoi(result) || result.state == tracking::State::kLost) return message;
  for (const Eigen::Vector2d& corner : currentCorners(result)) {
    if (!corner.allFinite()) {
      message.polygon.points.clear();
      return message;
    }
    geometry_msgs::Point32 point;
    point.x = static_cast<float>(corner.x());
    point.y = static_cast<float>(corner.y());
    message.polygon.points.push_back(point);
  }
  return message;
}

sensor_msgs::ImagePtr imageMessage(const std_msgs::Header& header, const cv::Mat& image) {
  namespace encodings = sensor_msgs::image_encodings;
  const std::string& encoding = image.type() == CV_8UC1 ? encodings::MONO8 : encodings::BGR8;
  return cv_bridge::CvImage(header, encoding, image).toImageMsg();
}

}  // namespace laparoscope_servo
