// Markers of the simulated scene and of the scope, for rviz.
#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/sim/instrument.h"

namespace laparoscope_servo {

// A marker with a name and a frame; the rest has its defaults.
visualization_msgs::Marker marker(const std::string& frame, const std::string& name, int id, int type);

// The texture on its plane, `width` m wide, as a mesh of coloured triangles in `frame`.
visualization_msgs::Marker tissueMarker(const std::string& frame, const Eigen::Isometry3d& frame_T_tissue,
                                        const cv::Mat& texture, double width);

// A cylinder from a to b [m, in `frame`]; deletes the marker if they are (nearly) equal.
visualization_msgs::Marker cylinderMarker(const std::string& frame, const std::string& name, int id,
                                          const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius);

// The camera's field of view up to `depth` [m], as lines in the camera's frame.
visualization_msgs::Marker viewMarker(const std::string& frame, const geometry::PinholeCamera& camera,
                                      const cv::Size& size, double depth);

void setColour(visualization_msgs::Marker& marker, double red, double green, double blue, double alpha);

}  // namespace laparoscope_servo
