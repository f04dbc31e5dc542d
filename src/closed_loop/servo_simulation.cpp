#include "laparoscope_servo/closed_loop/servo_simulation.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>

#include "closed_loop/noise.h"
#include "closed_loop/simulated_picture.h"
#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/insertion_point.h"

namespace laparoscope_servo::closed_loop {

namespace {

constexpr double kStep = 0.001;  // s, of the integration

servo::Task taskOf(const std::string& name) {
  if (name == "STABILISE") return servo::Task::kStabilise;
  if (name == "CENTRE_TIP") return servo::Task::kCentreTip;
  if (name == "FOLLOW") return servo::Task::kFollow;
  if (name == "POINTS") return servo::Task::kPoints;
  if (name == "POSITION") return servo::Task::kPosition;
  if (name == "PARALLEL") return servo::Task::kParallel;
  return servo::Task::kHoldView;
}

class Loop {
 public:
  Loop(const ControllerSetup& controller, const SimulationConfig& config, unsigned seed)
      : config_(config),
        shaft_R_camera_(scope::obliqueOptics(config.optics_angle, config.optics_roll).transpose()),
        picture_(config, controller.control, shaft_R_camera_.transpose()),
        controller_(controller.control),
        actuator_(config.robot),
        patient_(config.patient, {0.0, 0.0, config.tissue_distance}),
        noise_(seed),
        insertion_point_(shaft_R_camera_.transpose() * Eigen::Vector3d(0.0, 0.0, -config.depth)),
        body_(startPose(), insertion_point_, config.scope_length, config.wrist),
        signs_(config.signs[0], config.signs[1], config.signs[2], config.signs[3]) {
    controller_.select(taskOf(config.task));
  }

  bool seesRoi(double time) const { return picture_.nearestToBorder(trueHomography(time)) >= 0.0; }

  void expose(double time) {
    images_.emplace_back(time,
                         picture_.expose(controller_.task(), time, trueHomography(time), believedDepth(), noise_));
  }

  SimulationSample control(double time) {
    servo::ControllerInput input;
    input.time = time;
    input.robot = {"", true, 0.0};
    while (!images_.empty() && images_.front().first + config_.image_delay <= time + 1e-9) {
      latest_ = images_.front();
      images_.pop_front();
    }
    servo::TaskErrorInput& seen = input.seenBy(controller_.task());
    seen = latest_.second;
    seen.image_time = latest_.first;
    seen.age = seen.image_age = std::max(0.0, time - latest_.first);
    input.robot = {"", true, 0.0};
    input.dead_man = {true, 0.0};
    input.depth.problem.clear();
    input.depth.d2 = believedDepth();
    input.depth.camera_R_shaft = shaft_R_camera_.transpose();
    input.depth.lateral_offset = body_.lateralOffset();
    if (config_.poses) input.depth.insertion_point_T_tip = measuredPose();
    if (config_.reports) {
      const Eigen::Vector2d a = noise_.draw(config_.report_noise), b = noise_.draw(config_.report_noise);
      input.robot_report.present = true;
      input.robot_report.velocity =
          scope::Velocity::fromVector(executed_ + Eigen::Vector4d(a.x(), a.y(), b.x(), 0.1 * b.y()));
      input.robot_report.age = time - reported_;
    }
    if (!engaged_once_) engaged_once_ = controller_.engage(input).empty();
    const bool announced = controller_.figures().parallel.stage == servo::ParallelStage::kAnnounced;
    if (!announced) announced_at_ = time;
    if (announced && time - announced_at_ >= config_.reading_time) controller_.engage(input);
    const servo::ControllerOutput output = controller_.update(input);
    actuator_.command(time, output.command.vector());
    executed_ = actuator_.velocity(time);
    reported_ = time;
    return sample(time, output);
  }

  // The midpoint rule: d1 changes while the scope is pushed in.
  void move(double time) {
    body_.moveInsertionPoint(insertion_point_ + patient_.trocarOffset(time));
    if (time >= config_.picture.frozen_from && !picture_.isFrozen()) picture_.freeze(trueHomography(time));
    const scope::Velocity executed = scope::Velocity::fromVector(actuator_.velocity(time).cwiseProduct(signs_));
    moved_ += kStep * executed.vector();
    sim::ScopeBody halfway = body_;
    halfway.move(endEffectorTwist(executed, believedDepth()), 0.5 * kStep);
    body_.move(endEffectorTwist(executed, config_.believed_depth_factor * halfway.depth()), kStep);
  }

 private:
  // The tip in the frame of the assumed insertion point, which is wrong by the factor along the shaft at the reference;
  // z points out of the body.
  Eigen::Isometry3d measuredPose() {
    Eigen::Isometry3d world_T_insertion_point = Eigen::Isometry3d::Identity();
    world_T_insertion_point.linear() = insertionPointAxes();
    world_T_insertion_point.translation() = config_.believed_depth_factor * insertion_point_;
    Eigen::Isometry3d pose = world_T_insertion_point.inverse() * body_.pose();
    if (config_.pose_turn != 1.0) pose = Eigen::Isometry3d(toldTurn(pose.linear()) * pose);
    const Eigen::Vector2d xy = noise_.draw(config_.pose_noise), z = noise_.draw(config_.pose_noise);
    const Eigen::Vector2d turn = noise_.draw(config_.direction_noise);
    pose.translation() += Eigen::Vector3d(xy.x(), xy.y(), z.x());
    pose.linear() = pose.linear() * geometry::so3Exp({turn.x(), turn.y(), 0.0});
    return pose;
  }

  // world_R_insertion_point: z points out of the body at the reference.
  Eigen::Matrix3d insertionPointAxes() const {
    return shaft_R_camera_.transpose() * geometry::so3Exp({M_PI, 0.0, 0.0});
  }

  // About the insertion point, from the true pose to the one that the arm tells: the turns since the first one.
  Eigen::AngleAxisd toldTurn(const Eigen::Matrix3d& insertion_point_R_shaft) {
    if (!first_R_shaft_) first_R_shaft_ = insertion_point_R_shaft;
    const Eigen::Vector3d turned = geometry::so3Log(insertion_point_R_shaft * first_R_shaft_->transpose());
    return {(config_.pose_turn - 1.0) * turned.norm(), turned.stableNormalized()};
  }

  // The tissue's normal in the camera's frame.
  Eigen::Vector3d normalInCamera(double time) const {
    return (shaft_R_camera_.transpose() * body_.pose().linear().transpose()) *
           (patient_.tissueMotion(time).linear() * normalInWorld());
  }

  // world_T_tip; the world is the camera's frame at the reference.
  Eigen::Isometry3d startPose() const {
    Eigen::Isometry3d world_T_shaft = Eigen::Isometry3d::Identity();  // at O_A
    world_T_shaft.linear() = shaft_R_camera_.transpose();
    world_T_shaft.translation() = insertion_point_;
    Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
    turned.linear() = geometry::so3Exp({config_.start.tilt, config_.start.pan, 0.0}) *
                      geometry::so3Exp({0.0, 0.0, config_.start.spin});
    return world_T_shaft * turned * Eigen::Translation3d(0.0, 0.0, config_.depth + config_.start.insertion);
  }

  Eigen::Vector3d normalInWorld() const {
    return geometry::so3Exp({config_.tissue_slant_x, config_.tissue_slant_y, 0.0}) * Eigen::Vector3d::UnitZ();
  }

  Eigen::Matrix3d trueHomography(double time) const {
    const Eigen::Vector3d normal = normalInWorld();
    Eigen::Isometry3d tip_T_camera = Eigen::Isometry3d::Identity();
    tip_T_camera.linear() = shaft_R_camera_;
    const Eigen::Isometry3d camera_T_world = (body_.pose() * tip_T_camera).inverse();
    // The plane meets the reference camera's axis at tissue_distance.
    return geometry::fromPlane(camera_T_world * patient_.tissueMotion(time), normal,
                               config_.tissue_distance * normal.z());
  }

  double believedDepth() const { return config_.believed_depth_factor * body_.depth(); }

  geometry::Vector6d endEffectorTwist(const scope::Velocity& velocity, double believed_depth) const {
    return scope::endEffectorTwist(velocity, body_.length() - believed_depth);  // eq. (12)
  }

  SimulationSample sample(double time, const servo::ControllerOutput& output) const {
    SimulationSample s;
    s.t = time;
    s.command = output.command;
    s.moved = moved_;
    const servo::ControllerFigures figures = controller_.figures();
    s.evidence = figures.evidence;
    s.unconfirmed = figures.unconfirmed;
    s.leash = figures.leash;
    const Eigen::Matrix3d tissue = trueHomography(time);
    const Eigen::Matrix3d h = picture_.seen(tissue);
    const Eigen::Vector2d centre =
        geometry::apply(geometry::pixelsFromNormalised(h, config_.camera), config_.roi.centre());
    s.u = centre.x();
    s.v = centre.y();
    s.worst_corner = picture_.nearestToBorder(tissue);
    try {
      const servo::TaskError error = servo::taskError(h, config_.roi, config_.camera);
      s.log_depth = error.log_depth;
      s.alpha = error.alpha;
    } catch (const std::invalid_argument&) {  // the tissue is behind the camera
      s.log_depth = s.alpha = std::nan("");
    }
    s.d2 = body_.depth();
    s.d1 = body_.length() - s.d2;
    const auto executed = scope::Velocity::fromVector(executed_);
    const geometry::Vector6d tip = body_.tipTwist(endEffectorTwist(executed, believedDepth()));
    s.lateral_speed = scope::twistAtInsertionPoint(tip, s.d2).head<2>().norm();                       // eq. (9)
    s.commanded_lateral_speed = scope::twistAtInsertionPoint(tip, believedDepth()).head<2>().norm();  // eq. (9)
    s.lateral_offset = body_.lateralOffset();
    s.slant = geometry::angleBetween(normalInCamera(time), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d known = insertionPointAxes() * figures.parallel.normal;
    const Eigen::Vector3d there = patient_.tissueMotion(time).linear() * normalInWorld();
    s.normal_error = figures.parallel.is_known ? geometry::angleBetween(known, there) : std::nan("");
    s.state = output.state;
    return s;
  }

  SimulationConfig config_;
  Eigen::Matrix3d shaft_R_camera_;
  SimulatedPicture picture_;
  servo::Controller controller_;
  sim::ScopeActuator actuator_;
  sim::Patient patient_;
  Noise noise_;
  Eigen::Vector3d insertion_point_;  // at rest, in the world
  sim::ScopeBody body_;
  Eigen::Vector4d executed_ = Eigen::Vector4d::Zero();  // at the last step of the controller
  double reported_ = 0.0;                               // s, time of that step
  std::deque<std::pair<double, servo::TaskErrorInput>> images_;
  std::pair<double, servo::TaskErrorInput> latest_{0.0, servo::TaskErrorInput()};
  bool engaged_once_ = false;
  double announced_at_ = 0.0;  // s, of PARALLEL
  std::optional<Eigen::Matrix3d> first_R_shaft_;
  Eigen::Vector4d signs_;
  Eigen::Vector4d moved_ = Eigen::Vector4d::Zero();  // displacement of the scope
};

}  // namespace

bool startSeesRoi(const SimulationConfig& config) {
  return Loop(ControllerSetup(), config, 0).seesRoi(0.0);
}

std::vector<SimulationSample> simulate(const ControllerSetup& controller, const SimulationConfig& config, unsigned seed,
                                       double duration) {
  Loop loop(controller, config, seed);
  if (!loop.seesRoi(0.0)) throw std::invalid_argument("the start pose does not see the region of interest");
  std::vector<SimulationSample> samples;
  std::int64_t images = 0;
  std::int64_t steps = 0;
  for (std::int64_t k = 0;; ++k) {
    const double time = static_cast<double>(k) * kStep;
    if (time > duration + 1e-9) return samples;
    if (time >= static_cast<double>(images) / config.frame_rate - 1e-9) {
      loop.expose(time);
      ++images;
    }
    if (time >= static_cast<double>(steps) / controller.rate - 1e-9) {
      samples.push_back(loop.control(time));
      ++steps;
    }
    loop.move(time);
  }
}

}  // namespace laparoscope_servo::closed_loop
