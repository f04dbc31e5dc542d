// Tracks the pose of a rigid object of known shape through a sequence of images, by its edges: virtual visual servoing
// (Marchand and Chaumette 2004, III).
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3), without distortion, all of one size and type; stamps
// are seconds, from the images. The tracker keeps no clock and no global state: the same images give the same results.
// It is not thread-safe, and does not allocate in track() while it is TRACKING.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/model/cad_model.h"
#include "laparoscope_servo/model/model_config.h"

namespace laparoscope_servo::model {

struct ModelResult {
  features::State state = features::State::kIdle;
  features::Reason reason = features::Reason::kNothingSelected;  // why the state is not TRACKING
  // TRACKING: as seen; SEARCHING and LOST: where it is expected. m
  Eigen::Isometry3d camera_T_object = Eigen::Isometry3d::Identity();
  // Of the pose in the last image in which the state was TRACKING: translation of the object's origin, m, and rotation
  // vector, rad, both along the camera's axes, as in geometry_msgs/PoseWithCovariance. What nothing in the image shows,
  // as the turn of a lone cylinder about its axis, has the variance with which it was known before.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  double share = 0.0;  // of the sites in the image, those that agree with the pose
  double sigma = 0.0;  // px, robust standard deviation of the edges about the model's
  // px, standard deviation of where the model's worst point is in the image; infinite unless TRACKING
  double expected_error = 0.0;
  bool selected_now = false;
};

class ModelTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration, or says what is wrong with the camera.
  ModelTracker(std::shared_ptr<const CadModel> model, const geometry::PinholeCamera& camera,
               const ModelConfig& config = {});
  ~ModelTracker();
  ModelTracker(ModelTracker&&) noexcept;
  ModelTracker& operator=(ModelTracker&&) noexcept;

  // Looks for the model about `camera_T_object`, as far away as the configuration says, and takes what is found for the
  // object to be tracked. Throws std::invalid_argument, with what was found and what was expected, when the image shows
  // it nowhere there, or when two poses cannot be told apart; the tracker then goes on as before.
  const ModelResult& select(const cv::Mat& image, double stamp, const Eigen::Isometry3d& camera_T_object);

  // Processes the next image. A stamp before the last one, or an image of another size or type than the selection's,
  // resets to IDLE, with the reason. `motion`: takes coordinates in the camera's frame of the last image to those in
  // this one's, of an object at rest, where something else knows the camera's motion; otherwise the object's last
  // motion is expected to go on. The result lasts until the next call.
  const ModelResult& track(const cv::Mat& image, double stamp,
                           const std::optional<Eigen::Isometry3d>& motion = std::nullopt);

  // Forgets the object.
  void reset();

  const ModelResult& result() const;
  const CadModel& model() const;
  const geometry::PinholeCamera& camera() const;
  // Each site of the last image.
  const std::vector<features::SiteFinding>& findings() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::model
