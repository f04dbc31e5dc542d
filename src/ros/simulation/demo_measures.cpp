#include "ros/simulation/demo_measures.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace laparoscope_servo {

namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kMillimetres = 1e3;

class Object {
 public:
  void add(const std::string& name, double value) {
    std::ostringstream text;
    text << std::setprecision(6) << value;
    raw(name, std::isfinite(value) ? text.str() : "null");
  }
  void add(const std::string& name, int value) { raw(name, std::to_string(value)); }
  void add(const std::string& name, bool value) { raw(name, value ? "true" : "false"); }
  void add(const std::string& name, const std::string& value) {
    std::string escaped;
    for (const char c : value) {
      if (c == '"' || c == '\\') escaped += '\\';
      escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    raw(name, '"' + escaped + '"');
  }
  std::string text() const { return "{\n" + text_ + "\n}\n"; }

 private:
  void raw(const std::string& name, const std::string& value) {
    text_ += (text_.empty() ? "  \"" : ",\n  \"") + name + "\": " + value;
  }
  std::string text_;
};

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
  Object object;
  object.add("converged", summary.converged);
  object.add("reason", summary.reason);
  object.add("total_frames", summary.total_frames);
  object.add("tracked_frames", summary.tracked_frames);
  object.add("start_error_px", summary.start_error_px);
  object.add("start_scale_error", summary.start_scale_error);
  object.add("start_angle_deg", summary.start_truth.angle * kDegrees);
  object.add("start_depth_mm", summary.start_truth.depth * kMillimetres);
  object.add("settling_time_s", summary.settling_time);
  object.add("final_error_px", summary.final_error_px);
  object.add("final_scale_error", summary.final_scale_error);
  object.add("final_angle_deg", summary.final_truth.angle * kDegrees);
  object.add("final_depth_mm", summary.final_truth.depth * kMillimetres);
  object.add("final_lateral_mm", summary.final_truth.lateral * kMillimetres);
  object.add("instrument_crossed", summary.crossed);
  if (summary.crossed) {
    object.add("crossing_frames", summary.crossing_frames);
    object.add("crossing_tracked_frames", summary.crossing_tracked_frames);
    object.add("crossing_visible_fraction", summary.crossing_visible_fraction);
    object.add("crossing_error_px", summary.crossing_error_px);
  }
  return object.text();
}

}  // namespace laparoscope_servo
