// The loop closed by images: the scope of SimulatedCart, whose camera renders tissue with any texture, and an eye,
// which makes the task's error of each image as the nodes do it.
#pragma once

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/point_feature_tracker.h"
#include "laparoscope_servo/motion/anchored_motion.h"
#include "laparoscope_servo/motion/dominant_motion.h"
#include "laparoscope_servo/servo/place_error.h"
#include "laparoscope_servo/servo/points_error.h"
#include "laparoscope_servo/servo/view_region.h"
#include "laparoscope_servo/sim/scope_camera.h"
#include "support/simulated_cart.h"

namespace laparoscope_servo::test {

// Ages, the image's time and the region are filled in by who asks.
using Eye = std::function<servo::TaskErrorInput(const cv::Mat& image, double time)>;

// Of STABILISE and PARALLEL: the whole view, since the first image.
class ViewEye {
 public:
  ViewEye(const geometry::PinholeCamera& camera, const cv::Size& size)
      : camera_(camera), region_(servo::viewRegion(size.width, size.height)) {}

  servo::TaskErrorInput see(const cv::Mat& image, double time) {
    const motion::AnchoredResult& seen = motion_.track(image, time);
    servo::TaskErrorInput input;
    input.problem.clear();
    input.valid = seen.state == features::State::kTracking;
    if (!input.valid) return input;
    servo::ViewMotion view;
    view.h = geometry::normalisedFromPixels(seen.g, camera_);
    view.corners = geometry::apply(camera_.inverseMatrix(), region_.corners());
    view.error = seen.expected_error / camera_.fx;
    input.error = servo::taskError(view.h, region_, camera_);
    input.motion = view;
    input.visible_fraction = seen.share > 0.0 ? seen.share : motion_.step().share;
    input.corner_error = seen.expected_error;
    return input;
  }
  const motion::AnchoredResult& motion() const { return motion_.result(); }
  const motion::MotionResult& step() const { return motion_.step(); }

 private:
  geometry::PinholeCamera camera_;
  geometry::Rectangle region_;
  motion::AnchoredMotion motion_;
};

// Of FOLLOW: the middle of an object's region, as ObjectPlace has it.
class ObjectEye {
 public:
  ObjectEye(const geometry::PinholeCamera& camera, const geometry::Rectangle& region)
      : camera_(camera), region_(region) {}

  servo::TaskErrorInput see(const cv::Mat& image, double time) {
    const bool is_first = !is_begun_;
    is_begun_ = true;
    const motion::MotionResult& seen = is_first ? motion_.begin(image, time, region_) : motion_.track(image, time);
    servo::TaskErrorInput input;
    if (lost_.empty() && !is_first && seen.state != features::State::kTracking)
      lost_ = "the object was lost: " + std::string(reasonText(seen.reason));
    input.problem = lost_;
    if (isLost()) return input;
    if (!is_first) variance_ += seen.expected_error * seen.expected_error;
    place_ = region_.centre();
    if (!is_first) {
      place_.setZero();
      for (const Eigen::Vector2d& corner : seen.region) place_ += 0.25 * corner;
    }
    input.valid = true;
    input.visible_fraction = is_first ? 1.0 : seen.share;
    input.corner_error = std::sqrt(variance_);
    input.error = servo::placeError((camera_.inverseMatrix() * place_.homogeneous()).head<2>(), {0.0, 0.0});
    return input;
  }
  const Eigen::Vector2d& place() const { return place_; }  // px
  const motion::MotionResult& motion() const { return motion_.result(); }
  bool isLost() const { return !lost_.empty(); }

 private:
  geometry::PinholeCamera camera_;
  geometry::Rectangle region_;
  motion::DominantMotion motion_;
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double variance_ = 0.0;  // px^2
  bool is_begun_ = false;
  std::string lost_;  // why; empty: it is not
};

// Of POINTS: corners of a stored picture, found in the first image, as PointsInput has it.
class PointsEye {
 public:
  PointsEye(const geometry::PinholeCamera& camera, const cv::Mat& picture, int count,
            const servo::ControllerConfig& config)
      : camera_(camera), error_(config.points, config.features.desired_depth), selection_(1) {
    selection_[0].id = "tissue";
    selection_[0].corners = features::CornerSelection{{}, count};
    selection_[0].picture = picture;
  }

  // Throws std::invalid_argument where the first image does not show the picture.
  servo::TaskErrorInput see(const cv::Mat& image, double time) {
    const features::TrackedFeatures& seen =
        is_selected_ ? tracker_.track(image, time, {}) : tracker_.select(image, time, selection_, {});
    is_selected_ = true;
    points_.clear();
    tracked_ = 0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const features::TrackedFeature& feature : seen.features) {
      servo::PointTask& point = points_.emplace_back();
      const bool is_seen = feature.state == features::State::kTracking;
      point.desired = normalised(feature.desired);
      point.weight = is_seen ? 1.0 : 0.0;
      if (is_seen) point.point = normalised(feature.parameters);
      tracked_ += is_seen ? 1 : 0;
      middle += point.desired / static_cast<double>(seen.features.size());
    }
    servo::TaskErrorInput input;
    input.problem.clear();
    const servo::PointsSeen found = error_.from(points_, middle, {Eigen::Matrix3d::Identity(), SimulatedCart::kDepth});
    input.valid = found.is_known;
    if (!input.valid) return input;
    input.error = found.error;
    input.visible_fraction = static_cast<double>(found.agreeing) / static_cast<double>(points_.size());
    input.corner_error = std::max(camera_.fx, camera_.fy) * found.stddev;
    return input;
  }
  int tracked() const { return tracked_; }
  int selected() const { return static_cast<int>(points_.size()); }

 private:
  Eigen::Vector2d normalised(const Eigen::VectorXd& pixel) const {
    return (camera_.inverseMatrix() * Eigen::Vector3d(pixel[0], pixel[1], 1.0)).head<2>();
  }

  geometry::PinholeCamera camera_;
  features::PointFeatureTracker tracker_;
  servo::PointsError error_;
  features::FeatureSelection selection_;
  std::vector<servo::PointTask> points_;
  bool is_selected_ = false;
  int tracked_ = 0;
};

class ImageLoop {
 public:
  // `start`: from the reference pose, at which the tissue lies as the scene says. An empty texture: the scene's own.
  ImageLoop(const sim::SceneConfig& scene, const cv::Mat& texture, servo::Task task, const scope::Velocity& start)
      : cart_(servo::ControllerConfig(), start, 5), camera_(cameraOf(scene, texture)), task_(task) {
    cart_.interference.input = [this](servo::ControllerInput& input, double time) {
      servo::TaskErrorInput& seen = input.seenBy(task_);
      seen = seen_;
      seen.age = seen.image_age = time - seen_.image_time.value_or(time);
      input.depth.age = 0.0;  // the pose is that of now
    };
    cart_.controller.select(task);
  }
  ImageLoop(const ImageLoop&) = delete;
  ImageLoop& operator=(const ImageLoop&) = delete;

  // What the camera shows from the reference pose.
  cv::Mat reference() { return camera_.render(Eigen::Isometry3d::Identity(), 0.0).image; }

  // One image, and what happens until the next one.
  void step(const Eye& eye) {
    seen_ = eye(camera_.render(seenFrom(), cart_.time()).image, cart_.time());
    seen_.region = 1.0;
    seen_.image_time = cart_.time();
    for (int k = 0; k < SimulatedCart::kImageTicks; ++k) cart_.step();
  }
  std::string engage() { return cart_.controller.engage(cart_.input()); }

  SimulatedCart& cart() { return cart_; }
  sim::ScopeCamera& camera() { return camera_; }
  // Of the tissue from where the scene has it, at a time [s]; none: it rests.
  std::function<Eigen::Isometry3d(double)> tissue_motion;

  // rad, of the tissue against the image plane.
  double slant() const {
    return geometry::angleBetween(sim::planeSeenFrom(seenFrom(), camera_.tissue().pose()).normal,
                                  Eigen::Vector3d::UnitZ());
  }
  // Of tissue at rest, into it, in the frame of the insertion point, whose z axis points out of the body.
  Eigen::Vector3d normal() const {
    return geometry::so3Exp({M_PI, 0.0, 0.0}).transpose() * camera_.tissue().pose().linear().col(2);
  }
  // px, of where a point of the tissue is seen. `point`: m, in its plane.
  Eigen::Vector2d seenAt(const Eigen::Vector2d& point) const {
    const Eigen::Vector3d there =
        seenFrom().inverse() * (camera_.tissue().pose() * Eigen::Vector3d(point.x(), point.y(), 0.0));
    return (camera_.config().camera.intrinsics.matrix() * there).hnormalized();
  }

 private:
  // The camera, as the tissue sees it.
  Eigen::Isometry3d seenFrom() const {
    return tissue_motion ? tissue_motion(cart_.time()).inverse() * cart_.pose() : cart_.pose();
  }
  static sim::ScopeCamera cameraOf(const sim::SceneConfig& scene, const cv::Mat& texture) {
    const Eigen::Isometry3d tissue = sim::placeTissue(scene.tissue, Eigen::Isometry3d::Identity());
    return texture.empty() ? sim::ScopeCamera(scene, tissue) : sim::ScopeCamera(scene, texture, tissue);
  }

  SimulatedCart cart_;
  sim::ScopeCamera camera_;
  servo::Task task_;
  servo::TaskErrorInput seen_;
};

}  // namespace laparoscope_servo::test
