#include "ros/simulation/demo_measures.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ros/common/json_writer.h"

namespace laparoscope_servo {

namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kMillimetres = 1e3;

}  // namespace

ViewError viewError(const Homography& message, const geometry::Rectangle& roi) {
  Eigen::Matrix3d g;
  for (int k = 0; k < 9; ++k) g(k / 3, k % 3) = message.g[static_cast<std::size_t>(k)];
  const double area = geometry::signedArea(geometry::apply(g, roi.corners()));
  const double reference_area = geometry::signedArea(roi.corners());
  return {(geometry::apply(g, roi.centre()) - roi.centre()).norm(), std::abs(std::sqrt(area / reference_area) - 1.0)};
}

PoseError poseError(const Eigen::Isometry3d& base_T_reference, const Eigen::Isometry3d& base_T_camera,
                    const Eigen::Vector3d& insertion_point) {
  const Eigen::Isometry3d difference = base_T_reference.inverse() * base_T_camera;
  const Eigen::Vector3d axis = difference.linear().col(2);
  const double reference_depth = (base_T_reference.translation() - insertion_point).norm();
  return {std::atan2(axis.head<2>().norm(), axis.z()),
          (base_T_camera.translation() - insertion_point).norm() - reference_depth,
          difference.translation().head<2>().norm()};
}

void Settling::update(double time, bool tracking, const ViewError& error) {
  if (!(tracking && error.centre <= centre_ && error.scale <= scale_)) {
    inside_ = settled_ = false;
    return;
  }
  if (!inside_) since_ = time;
  inside_ = true;
  settled_ = time - since_ >= hold_;
}

std::string toJson(const DemoSummary& summary) {
  std::ostringstream text;
  JsonWriter json(text, 6);
  json.beginObject();
  json.value("converged", summary.converged);
  json.value("reason", summary.reason);
  json.value("total_frames", summary.total_frames);
  json.value("tracked_frames", summary.tracked_frames);
  json.value("start_error_px", summary.start_error_px);
  json.value("start_scale_error", summary.start_scale_error);
  json.value("start_angle_deg", summary.start_truth.angle * kDegrees);
  json.value("start_depth_mm", summary.start_truth.depth * kMillimetres);
  json.value("settling_time_s", summary.settling_time);
  json.value("final_error_px", summary.final_error_px);
  json.value("final_scale_error", summary.final_scale_error);
  json.value("final_angle_deg", summary.final_truth.angle * kDegrees);
  json.value("final_depth_mm", summary.final_truth.depth * kMillimetres);
  json.value("final_lateral_mm", summary.final_truth.lateral * kMillimetres);
  json.value("instrument_crossed", summary.crossed);
  if (summary.crossed) {
    json.value("crossing_frames", summary.crossing_frames);
    json.value("crossing_tracked_frames", summary.crossing_tracked_frames);
    json.value("crossing_visible_fraction", summary.crossing_visible_fraction);
    json.value("crossing_error_px", summary.crossing_error_px);
  }
  json.end();
  return text.str();
}

}  // namespace laparoscope_servo
