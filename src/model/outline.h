// The picture of a model from a pose, as a curve of the edge stage: its parameters are the six of the pose.
//
// Parameters: the twist (v, w) of the virtual camera for one unit of time, expressed in the camera's frame: m and rad.
// A step of it takes camera_T_object to se3Exp(step)^-1 camera_T_object (Marchand and Chaumette 2004, III.B). The
// displacement of a site along its normal is that of the point of the model that is seen there: sliding along a line,
// or along the surface of a cylinder where a ray touches it, does not change it.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/model/cad_model.h"
#include "model/visibility.h"

namespace laparoscope_servo::model {

// Of a point of the scene in the camera's frame: how its image, px, moves by the camera's twist; survey, eq. (7).
Eigen::Matrix<double, 2, 6> pointInteraction(const geometry::PinholeCamera& camera, const Eigen::Vector3d& point);
// How an object's pose moves by the camera's twist: translation of the object's origin, m, then rotation vector, rad,
// both along the camera's axes, which is the order and the kind of geometry_msgs/PoseWithCovariance.
geometry::Matrix6d poseInteraction(const Eigen::Isometry3d& camera_T_object);

// Where it is seen, px; the point's z has to be positive.
Eigen::Vector2d project(const geometry::PinholeCamera& camera, const Eigen::Vector3d& point);

class Outline : public features::Curve {
 public:
  Outline() = default;
  // `size`: of the images. What lies outside has no sites.
  Outline(std::shared_ptr<const CadModel> model, const geometry::PinholeCamera& camera, const cv::Size& size,
          const Eigen::Isometry3d& camera_T_object);

  const Eigen::Isometry3d& pose() const { return camera_T_object_; }
  void setPose(const Eigen::Isometry3d& camera_T_object) { camera_T_object_ = camera_T_object; }
  const CadModel& model() const { return *model_; }
  const geometry::PinholeCamera& camera() const { return camera_; }
  const Visibility& visibility() const { return visibility_; }
  // What can be seen from the present pose; moving leaves it as it is. See Visibility::update.
  void look(Occluders& occluders, int step = 1);
  void forgetVisibility() { visibility_.forget(); }
  // How far points of the model are from where they would be in another pose: the largest, px.
  double apart(const Eigen::Isometry3d& camera_T_object) const;
  // The model's centre, in the camera's frame.
  Eigen::Vector3d centre() const { return camera_T_object_ * model_->centre; }

  int parameters() const override { return 6; }
  int slots() const override;
  int likeSlots() const override { return kAlike; }
  void sites(double spacing, int most, std::vector<features::Site>& result) const override;
  void move(const Eigen::VectorXd& step) override;
  // A similarity: the model turns about the ray to its centre and comes nearer, and its centre goes where it is taken.
  void transform(const Eigen::Matrix3d& motion) override;
  void known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const override;
  void settle(const std::vector<features::SiteFinding>&, const Eigen::MatrixXd&, double) override {}
  bool isSound() const override;
  double change(const Curve& before) const override { return changeFrom(static_cast<const Outline&>(before).pose()); }
  // 1, and the change of the centre's depth, relative, or the turn, rad, whichever is larger.
  double changeFrom(const Eigen::Isometry3d& camera_T_object) const;

 private:
  static constexpr int kAlike = 2;  // slots either side, over which an edge looks alike
  // Between strands lie slots that no site has, so that no strand remembers the looks of another one.
  static constexpr int kStride = Visibility::kPieces + kAlike;

  double lengthInImage() const;
  void addSegment(int strand, double spacing, std::size_t most, std::vector<features::Site>& result) const;
  void addCircle(int strand, double spacing, std::size_t most, std::vector<features::Site>& result) const;
  bool clipped(int strand, Eigen::Vector3d& begin, Eigen::Vector3d& end, double& first, double& last) const;

  std::shared_ptr<const CadModel> model_;
  geometry::PinholeCamera camera_;
  cv::Size size_;
  Eigen::Isometry3d camera_T_object_ = Eigen::Isometry3d::Identity();
  Visibility visibility_;
};

}  // namespace laparoscope_servo::model
