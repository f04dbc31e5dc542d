#include "laparoscope_servo/model/model_tracker.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/features/image_sequence.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/robust/largest.h"
#include "laparoscope_servo/validation/error_report.h"
#include "model/model_start.h"
#include "model/outline.h"

namespace laparoscope_servo::model {

using features::Reason;
using features::State;

namespace {

constexpr double kLeastSurprise = 5.0;  // px

const ModelConfig& checked(const ModelConfig& config) {
  validation::throwErrors("model", validate(config));
  return config;
}

bool isRigid(const Eigen::Isometry3d& pose) {
  return pose.matrix().allFinite() &&
         (pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
         pose.linear().determinant() > 0.0;
}

}  // namespace

class ModelTracker::Implementation {
 public:
  Implementation(std::shared_ptr<const CadModel> model, const geometry::PinholeCamera& camera,
                 const ModelConfig& config)
      : model_(std::move(model)),
        camera_(camera),
        config_(checked(config)),
        fit_(config_.edges),
        keeper_(config_.edges.state) {
    if (model_ == nullptr) throw std::invalid_argument("no model, expected one");
    if (!camera_.error().empty()) throw std::invalid_argument(camera_.error());
  }

  void select(const cv::Mat& image, double stamp, const Eigen::Isometry3d& pose) {
    image::checkImage(image, stamp);
    if (!isRigid(pose)) throw std::invalid_argument("the pose is not rigid, expected a rotation and a finite position");
    Outline found(model_, camera_, image.size(), pose);
    if (!found.isSound()) {
      throw std::invalid_argument("the model's centre is at z = " + std::to_string(found.centre().z()) +
                                  " m, expected it in front of the camera");
    }
    checkInImage(found, image.size());
    features::EdgeFit fit(config_.edges);
    const StartResult start = ModelStart(config_).find(image, found, fit);
    if (start.report.reason != Reason::kNone) refuse(start);
    fit_ = std::move(fit);
    home_ = last_ = found.pose();
    expected_ = now_ = found;
    occluders_.reserve(*model_);
    begin(image, stamp);
    result_.selected_now = true;
    tell(start.report, found);
  }

  void track(const cv::Mat& image, double stamp, const std::optional<Eigen::Isometry3d>& motion) {
    result_.selected_now = false;
    if (!accepts(image, stamp)) return idle();
    const bool tracking = keeper_.state() == State::kTracking;
    expect(tracking, stamp, motion);
    now_ = expected_;
    features::EdgeReport report =
        fit_.fit(image, expected_, now_, config_.edges.range, !tracking, kLeastSurprise + usual_jump_);
    if (report.reason == Reason::kNone && !(now_.changeFrom(home_) <= 1.0 + config_.edges.max_change)) {
      report.reason = Reason::kShape;
    }
    keeper_.step(report.reason, stamp);
    if (keeper_.state() == State::kTracking) {
      if (tracking) {
        measureVelocity(stamp);
        usual_jump_ = std::max(fit_.jump(), 0.9 * usual_jump_);
      } else {
        begin(image, stamp);
      }
      fit_.remember();
      home_ = last_ = now_.pose();
    } else {
      velocity_.setZero();
      last_ = report.reason == Reason::kNone ? now_.pose() : home_;
    }
    sequence_.goOn(stamp);
    now_.setPose(last_);
    tell(report, now_);
  }

  void reset() {
    keeper_.reset(Reason::kReset);
    idle();
  }

  const ModelResult& result() const { return result_; }
  const std::vector<features::SiteFinding>& findings() const { return fit_.findings(); }
  const CadModel& model() const { return *model_; }
  const geometry::PinholeCamera& camera() const { return camera_; }

 private:
  // By the sphere around it.
  void checkInImage(const Outline& outline, const cv::Size& size) const {
    const Eigen::Vector3d centre = outline.centre();
    const double depth = centre.z() - model_->radius;
    if (!(depth > 0.0)) return;  // it may be anywhere
    const Eigen::Vector2d place = project(camera_, centre);
    const double reach = std::max(camera_.fx, camera_.fy) * model_->radius / depth * (1.0 + centre.norm() / centre.z());
    if (place.x() + reach >= 0.0 && place.y() + reach >= 0.0 && place.x() - reach < size.width &&
        place.y() - reach < size.height)
      return;
    std::ostringstream text;
    text << "the model lies outside the image: its centre at (" << place.x() << ", " << place.y()
         << ") px, expected a part of it in the image of " << size.width << " x " << size.height << " px";
    throw std::invalid_argument(text.str());
  }

  [[noreturn]] void refuse(const StartResult& start) const {
    std::ostringstream text;
    text.precision(3);
    text << "no start: " << features::reasonText(start.report.reason) << " (" << start.report.used << " of "
         << start.report.inside << " sites in the image agree, expected a share of " << config_.start_share
         << "; evidence " << start.report.evidence << ", of another pose " << start.other_evidence << ")";
    throw std::invalid_argument(text.str());
  }

  // False: the image was not for this tracker, which is IDLE now if it was not before.
  bool accepts(const cv::Mat& image, double stamp) {
    const Reason ended = sequence_.judge(image, stamp);
    if (keeper_.state() == State::kIdle) return false;
    if (ended != Reason::kNone) keeper_.reset(ended);
    return ended == Reason::kNone;
  }

  void begin(const cv::Mat& image, double stamp) {
    sequence_.begin(image, stamp);
    tracked_stamp_ = stamp;
    usual_jump_ = 0.0;
    velocity_.setZero();
    keeper_.select(stamp);
  }

  void expect(bool tracking, double stamp, const std::optional<Eigen::Isometry3d>& motion) {
    expected_.setPose(last_);
    at_rest_ = last_;
    if (motion && isRigid(*motion)) {
      expected_.setPose(*motion * last_);
      if (expected_.isSound()) {
        home_ = *motion * home_;
        at_rest_ = expected_.pose();
      } else {
        expected_.setPose(last_);
      }
    } else if (tracking) {
      const geometry::Vector6d step = config_.edges.velocity_damping * (stamp - tracked_stamp_) * velocity_;
      expected_.setPose(geometry::se3Exp(step).inverse() * last_);
      if (!expected_.isSound() || !(expected_.changeFrom(last_) <= 1.0 + config_.edges.max_change)) {
        expected_.setPose(last_);
      }
    }
    expected_.look(occluders_);
  }

  // Of what the camera's motion, where it is known, does not explain: as the twist of a camera before an object at
  // rest.
  void measureVelocity(double stamp) {
    const double passed = stamp - tracked_stamp_;
    tracked_stamp_ = stamp;
    if (!(passed > 0.0)) return;
    const Eigen::Isometry3d moved = at_rest_ * now_.pose().inverse();
    velocity_.tail<3>() = geometry::so3Log(moved.linear()) / passed;
    velocity_.head<3>() = moved.translation() / passed;
  }

  void idle() {
    result_.state = keeper_.state();
    result_.reason = keeper_.reason();
    result_.share = result_.sigma = 0.0;
    result_.expected_error = std::numeric_limits<double>::infinity();
  }

  geometry::Matrix6d poseCovariance(const Outline& outline) const {
    const geometry::Matrix6d motion = poseInteraction(outline.pose());
    return motion * geometry::Matrix6d(fit_.covariance()) * motion.transpose();
  }

  double errorInImage(const Outline& outline) const {
    double worst = 0.0;
    const auto add = [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d here = outline.pose() * point;
      if (!(here.z() > 0.0)) return;
      const Eigen::Matrix<double, 2, 6> l = pointInteraction(camera_, here);
      const Eigen::Matrix2d c = l * geometry::Matrix6d(fit_.covariance()) * l.transpose();
      worst = robust::largest(worst, 0.5 * c.trace() + std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1)));
    };
    for (const Edge& edge : model_->edges) {
      add(model_->points[static_cast<std::size_t>(edge.begin)]);
      add(model_->points[static_cast<std::size_t>(edge.end)]);
    }
    for (const Cylinder& cylinder : model_->cylinders) {
      add(cylinder.begin);
      add(cylinder.end);
    }
    for (const Circle& circle : model_->circles) {
      add(circle.centre + circle.radius * circle.u);
      add(circle.centre + circle.radius * circle.v);
    }
    return std::sqrt(worst);
  }

  void tell(const features::EdgeReport& report, const Outline& outline) {
    result_.state = keeper_.state();
    result_.reason = keeper_.reason();
    result_.camera_T_object = outline.pose();
    result_.share = report.share;
    result_.sigma = report.sigma;
    result_.expected_error = std::numeric_limits<double>::infinity();
    if (result_.state != State::kTracking) return;
    result_.covariance = poseCovariance(outline);
    result_.expected_error = errorInImage(outline);
  }

  std::shared_ptr<const CadModel> model_;
  geometry::PinholeCamera camera_;
  ModelConfig config_;
  features::EdgeFit fit_;
  features::StateKeeper keeper_;
  Outline expected_, now_;
  Eigen::Isometry3d home_ = Eigen::Isometry3d::Identity();  // where it was seen last, moved on by what knows the motion
  Eigen::Isometry3d last_ = Eigen::Isometry3d::Identity();  // where it was, by the last image
  Eigen::Isometry3d at_rest_ = Eigen::Isometry3d::Identity();  // where it would be now, had it not moved by itself
  Occluders occluders_;
  ModelResult result_;
  geometry::Vector6d velocity_ = geometry::Vector6d::Zero();
  double tracked_stamp_ = 0.0, usual_jump_ = 0.0;
  features::ImageSequence sequence_;
};

ModelTracker::ModelTracker(std::shared_ptr<const CadModel> model, const geometry::PinholeCamera& camera,
                           const ModelConfig& config)
    : implementation_(std::make_unique<Implementation>(std::move(model), camera, config)) {}
ModelTracker::~ModelTracker() = default;
ModelTracker::ModelTracker(ModelTracker&&) noexcept = default;
ModelTracker& ModelTracker::operator=(ModelTracker&&) noexcept = default;

const ModelResult& ModelTracker::select(const cv::Mat& image, double stamp, const Eigen::Isometry3d& camera_T_object) {
  implementation_->select(image, stamp, camera_T_object);
  return implementation_->result();
}

const ModelResult& ModelTracker::track(const cv::Mat& image, double stamp,
                                       const std::optional<Eigen::Isometry3d>& motion) {
  implementation_->track(image, stamp, motion);
  return implementation_->result();
}

void ModelTracker::reset() {
  implementation_->reset();
}

const ModelResult& ModelTracker::result() const {
  return implementation_->result();
}

const CadModel& ModelTracker::model() const {
  return implementation_->model();
}

const geometry::PinholeCamera& ModelTracker::camera() const {
  return implementation_->camera();
}

const std::vector<features::SiteFinding>& ModelTracker::findings() const {
  return implementation_->findings();
}

}  // namespace laparoscope_servo::model
