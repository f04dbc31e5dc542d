// What of a model hides other parts of it, for one pose: rays from the camera against its faces and cylinders.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "laparoscope_servo/model/cad_model.h"

namespace laparoscope_servo::model {

class Occluders {
 public:
  Occluders() = default;
  explicit Occluders(const CadModel& model) { reserve(model); }
  // For models up to this one nothing is allocated afterwards.
  void reserve(const CadModel& model);
  // `faces`: those that point to the camera.
  void set(const CadModel& model, const Eigen::Isometry3d& camera_T_object, const std::vector<char>& faces);
  // Whether something lies between the camera and the point, in the camera's frame, z > 0, or beside that ray by less
  // than `margin`, in normalised coordinates.
  bool hides(const Eigen::Vector3d& point, double margin) const;

 private:
  struct Polygon {
    Eigen::Vector3d normal;  // in the camera's frame
    double distance;         // normal . X of its points; below 0: it points to the camera
    Eigen::Vector2d least, most;
    std::size_t first, count;  // of corners_
  };
  struct Tube {
    Eigen::Vector3d begin, axis;  // of length 1
    double length, radius;
  };

  bool hides(const Polygon& polygon, const Eigen::Vector3d& point, const Eigen::Vector2d& at, double margin) const;
  bool hides(const Tube& tube, const Eigen::Vector3d& point, double margin) const;

  std::vector<Polygon> polygons_;
  std::vector<Eigen::Vector2d> corners_;  // normalised
  std::vector<Tube> tubes_;
};

}  // namespace laparoscope_servo::model
