#include "ros/simulation/scene_markers.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

using visualization_msgs::Marker;

constexpr int kCells = 96;  // cells of the tissue's mesh along its width

void setPose(Marker& marker, const Eigen::Isometry3d& pose) {
  marker.pose.position = pointMessage(pose.translation());
  marker.pose.orientation = rotationMessage(pose.linear());
}

}  // namespace

Marker marker(const std::string& frame, const std::string& name, int id, int type) {
  Marker result;
  result.header.frame_id = frame;
  result.ns = name;
  result.id = id;
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1.0;
  setColour(result, 1.0, 1.0, 1.0, 1.0);
  return result;
}

void setColour(Marker& marker, double red, double green, double blue, double alpha) {
  marker.color.r = static_cast<float>(red);
  marker.color.g = static_cast<float>(green);
  marker.color.b = static_cast<float>(blue);
  marker.color.a = static_cast<float>(alpha);
}

Marker tissueMarker(const std::string& frame, const Eigen::Isometry3d& frame_T_tissue, const cv::Mat& texture,
                    double width) {
  const int rows = std::clamp(kCells * texture.rows / texture.cols, 1, 4 * kCells);
  cv::Mat colours;
  cv::resize(texture, colours, {kCells + 1, rows + 1}, 0.0, 0.0, cv::INTER_AREA);
  const double cell = width / kCells;

  Marker result = marker(frame, "tissue", 0, Marker::TRIANGLE_LIST);
  result.scale.x = result.scale.y = result.scale.z = 1.0;
  setPose(result, frame_T_tissue);
  const auto add = [&](int row, int column) {
    result.points.push_back(pointMessage({(column - kCells / 2.0) * cell, (row - rows / 2.0) * cell, 0.0}));
    const auto& bgr = colours.at<cv::Vec3b>(row, column);
    std_msgs::ColorRGBA colour;
    colour.r = static_cast<float>(bgr[2]) / 255.0F;
    colour.g = static_cast<float>(bgr[1]) / 255.0F;
    colour.b = static_cast<float>(bgr[0]) / 255.0F;
    colour.a = 1.0F;
    result.colors.push_back(colour);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < kCells; ++column) {
      // In the order for which the normals point out of the tissue, to the camera.
      add(row, column), add(row + 1, column), add(row, column + 1);
      add(row, column + 1), add(row + 1, column), add(row + 1, column + 1);
    }
  }
  return result;
}

Marker cylinderMarker(const std::string& frame, const std::string& name, int id, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b, double radius) {
  Marker result = marker(frame, name, id, Marker::CYLINDER);
  const double length = (b - a).norm();
  if (!(length > 1e-4)) {
    result.action = Marker::DELETE;
    return result;
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (a + b) / 2.0;
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), b - a).toRotationMatrix();
  setPose(result, pose);
  result.scale.x = result.scale.y = 2.0 * radius;
  result.scale.z = length;
  return result;
}

Marker viewMarker(const std::string& frame, const geometry::PinholeCamera& camera, const cv::Size& size, double depth) {
  Marker result = marker(frame, "view", 0, Marker::LINE_LIST);
  result.scale.x = 0.0008;
  setColour(result, 0.2, 0.9, 1.0, 0.8);
  const double right = size.width - 0.5, bottom = size.height - 0.5;
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& pixel : {Eigen::Vector3d(-0.5, -0.5, 1.0), Eigen::Vector3d(right, -0.5, 1.0),
                                       Eigen::Vector3d(right, bottom, 1.0), Eigen::Vector3d(-0.5, bottom, 1.0)}) {
    corners.emplace_back(depth * (camera.inverseMatrix() * pixel));
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    result.points.push_back(pointMessage(Eigen::Vector3d::Zero()));
    result.points.push_back(pointMessage(corners[k]));
    result.points.push_back(pointMessage(corners[k]));
    result.points.push_back(pointMessage(corners[(k + 1) % corners.size()]));
  }
  return result;
}

}  // namespace laparoscope_servo
