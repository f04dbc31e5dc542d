#include "laparoscope_servo/closed_loop/servo_simulation.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <stdexcept>

#include "closed_loop/noise.h"
#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/insertion_point.h"
#include "laparoscope_servo/servo/place_error.h"
#include "laparoscope_servo/servo/points_error.h"
#include "laparoscope_servo/servo/view_region.h"

namespace laparoscope_servo::closed_loop {

namespace {

constexpr double kStep = 0.001;         // s, of the integration
constexpr int kPointsAlong = 6;         // points in a row and in a column of the region
constexpr double kEnoughInView = 0.25;  // share of the reference image, as AnchoredMotion needs it

Eigen::Matrix3d pictureOf(const PictureConfig& config) {
  Eigen::Vector3d mirror = Eigen::Vector3d::Ones();
  if (config.mirror == "left_right") mirror.x() = -1.0;
  if (config.mirror == "up_down") mirror.y() = -1.0;
  return geometry::so3Exp({0.0, 0.0, config.roll}) * mirror.asDiagonal();
}

servo::Task taskOf(const std::string& name) {
  if (name == "STABILISE") return servo::Task::kStabilise;
  if (name == "CENTRE_TIP") return servo::Task::kCentreTip;
  if (name == "FOLLOW") return servo::Task::kFollow;
  if (name == "POINTS") return servo::Task::kPoints;
  return servo::Task::kHoldView;
}

class Loop {
 public:
  Loop(const ControllerSetup& controller, const SimulationConfig& config, unsigned seed)
      : config_(config),
        shaft_R_camera_(scope::obliqueOptics(config.optics_angle, config.optics_roll).transpose()),
        setup_(controller.control),
        points_error_(controller.control.points, controller.control.features.desired_depth),
        controller_(controller.control),
        actuator_(config.robot),
        patient_(config.patient, {0.0, 0.0, config.tissue_distance}),
        noise_(seed),
        insertion_point_(shaft_R_camera_.transpose() * Eigen::Vector3d(0.0, 0.0, -config.depth)),
        body_(startPose(), insertion_point_, config.scope_length, config.wrist),
        picture_(pictureOf(config.picture)),
        signs_(config.signs[0], config.signs[1], config.signs[2], config.signs[3]) {
    controller_.select(taskOf(config.task));
  }

  bool seesRoi(double time) const { return nearestToBorder(cornersAt(time, config_.roi)) >= 0.0; }

  void expose(double time) {
    servo::TaskErrorInput input;
    input.problem.clear();
    input.valid = false;
    const double covered = crossing(time);
    const double noise = config_.corner_noise * (1.0 + covered * (config_.crossing.noise - 1.0));
    input.visible_fraction = 1.0 - covered * config_.crossing.cover;
    input.corner_error = noise;
    switch (controller_.task()) {
      case servo::Task::kCentreTip:
        exposePlace(time, noise, {setup_.centre_tip.x, setup_.centre_tip.y}, input);
        break;
      case servo::Task::kFollow:
        exposePlace(time, noise, {setup_.follow.x, setup_.follow.y}, input);
        break;
      case servo::Task::kPoints:
        exposePoints(time, noise, input);
        break;
      default:
        exposeRegion(time, noise, input);
    }
    images_.emplace_back(time, input);
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
    const servo::ControllerOutput output = controller_.update(input);
    actuator_.command(time, output.command.vector());
    executed_ = actuator_.velocity(time);
    reported_ = time;
    return sample(time, output);
  }

  // The midpoint rule: d1 changes while the scope is pushed in.
  void move(double time) {
    body_.moveInsertionPoint(insertion_point_ + patient_.trocarOffset(time));
    if (time >= config_.picture.frozen_from && !frozen_) frozen_ = trueHomography(time);
    const scope::Velocity executed = scope::Velocity::fromVector(actuator_.velocity(time).cwiseProduct(signs_));
    moved_ += kStep * executed.vector();
    sim::ScopeBody halfway = body_;
    halfway.move(endEffectorTwist(executed, believedDepth()), 0.5 * kStep);
    body_.move(endEffectorTwist(executed, config_.believed_depth_factor * halfway.depth()), kStep);
  }

 private:
  bool isInImage(const Eigen::Vector2d& p) const {
    return p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= config_.width - 1.0 && p.y() <= config_.height - 1.0;
  }

  Eigen::Vector2d normalised(const Eigen::Vector2d& pixel) const {
    return (config_.camera.inverseMatrix() * pixel.homogeneous()).head<2>();
  }

  // A tip, or the middle of an object.
  void exposePlace(double time, double noise, const Eigen::Vector2d& desired, servo::TaskErrorInput& input) {
    const Eigen::Matrix3d g = geometry::pixelsFromNormalised(seenHomography(time), config_.camera);
    const Eigen::Vector2d place = geometry::apply(g, config_.roi.centre()) + noise_.draw(noise);
    input.valid = isInImage(place);
    input.error = servo::placeError(normalised(place), desired);
  }

  // Points of a grid about the region's centre. Those astray stay where they were in the reference image, whatever the
  // scope does.
  void exposePoints(double time, double noise, servo::TaskErrorInput& input) {
    const Eigen::Matrix3d g = geometry::pixelsFromNormalised(seenHomography(time), config_.camera);
    std::vector<servo::PointTask> points;
    int astray = 0;
    for (int k = 0; k < kPointsAlong * kPointsAlong; ++k) {
      const Eigen::Vector2d cell((k % kPointsAlong + 0.5) / kPointsAlong, (k / kPointsAlong + 0.5) / kPointsAlong);
      const Eigen::Vector2d reference(config_.roi.x + cell.x() * config_.roi.width,
                                      config_.roi.y + cell.y() * config_.roi.height);
      const bool is_astray = astray < config_.points_astray * (k + 1);
      astray += is_astray ? 1 : 0;
      const Eigen::Vector2d place = (is_astray ? reference : geometry::apply(g, reference)) + noise_.draw(noise);
      servo::PointTask& point = points.emplace_back();
      point.point = normalised(place);
      point.desired = normalised(reference);
      point.weight = isInImage(place) ? 1.0 : 0.0;
    }
    const servo::PointsSeen seen =
        points_error_.from(points, normalised(config_.roi.centre()), {shaft_R_camera_.transpose(), believedDepth()});
    input.valid = seen.is_known;
    input.error = seen.error;
    input.corner_error = config_.camera.fx * seen.stddev;
  }

  void exposeRegion(double time, double noise, servo::TaskErrorInput& input) {
    const bool whole = controller_.task() == servo::Task::kStabilise;
    const geometry::Rectangle region = whole ? servo::viewRegion(config_.width, config_.height) : config_.roi;
    geometry::Quadrilateral seen = cornersAt(time, region);
    if (whole ? referenceInView(time) >= kEnoughInView : nearestToBorder(seen) >= 0.0) {
      for (Eigen::Vector2d& corner : seen) corner += noise_.draw(noise);
      const Eigen::Matrix3d g = geometry::fromCorners(region.corners(), seen);
      input.error = servo::taskError(geometry::normalisedFromPixels(g, config_.camera), region, config_.camera);
      input.valid = true;
    }
  }

  // The tip in the frame of the assumed insertion point, which is wrong by the factor along the shaft at the reference;
  // z points out of the body.
  Eigen::Isometry3d measuredPose() {
    Eigen::Isometry3d world_T_insertion_point = Eigen::Isometry3d::Identity();
    world_T_insertion_point.linear() = shaft_R_camera_.transpose() * geometry::so3Exp({M_PI, 0.0, 0.0});
    world_T_insertion_point.translation() = config_.believed_depth_factor * insertion_point_;
    Eigen::Isometry3d pose = world_T_insertion_point.inverse() * body_.pose();
    const Eigen::Vector2d xy = noise_.draw(config_.pose_noise), z = noise_.draw(config_.pose_noise);
    const Eigen::Vector2d turn = noise_.draw(config_.direction_noise);
    pose.translation() += Eigen::Vector3d(xy.x(), xy.y(), z.x());
    pose.linear() = pose.linear() * geometry::so3Exp({turn.x(), turn.y(), 0.0});
    return pose;
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

  Eigen::Matrix3d trueHomography(double time) const {
    const Eigen::Vector3d normal =
        geometry::so3Exp({config_.tissue_slant_x, config_.tissue_slant_y, 0.0}) * Eigen::Vector3d::UnitZ();
    Eigen::Isometry3d tip_T_camera = Eigen::Isometry3d::Identity();
    tip_T_camera.linear() = shaft_R_camera_;
    const Eigen::Isometry3d camera_T_world = (body_.pose() * tip_T_camera).inverse();
    // The plane meets the reference camera's axis at tissue_distance.
    return geometry::fromPlane(camera_T_world * patient_.tissueMotion(time), normal,
                               config_.tissue_distance * normal.z());
  }

  // The homography in the picture, with the configured faults of the picture.
  Eigen::Matrix3d seenHomography(double time) const {
    return picture_ * (frozen_ ? *frozen_ : trueHomography(time)) * picture_.transpose();
  }

  geometry::Quadrilateral cornersAt(double time, const geometry::Rectangle& region) const {
    return geometry::apply(geometry::pixelsFromNormalised(seenHomography(time), config_.camera), region.corners());
  }

  // Share of the reference image that is in view.
  double referenceInView(double time) const {
    constexpr int kAlong = 10;
    const Eigen::Matrix3d g = geometry::pixelsFromNormalised(seenHomography(time), config_.camera);
    int seen = 0;
    for (int k = 0; k < kAlong * kAlong; ++k) {
      const Eigen::Vector3d p = g * Eigen::Vector3d((k % kAlong + 0.5) / kAlong * config_.width,
                                                    (k / kAlong + 0.5) / kAlong * config_.height, 1.0);
      const bool inside = p.z() > 0.0 && p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= config_.width * p.z() &&
                          p.y() <= config_.height * p.z();
      seen += inside ? 1 : 0;
    }
    return static_cast<double>(seen) / (kAlong * kAlong);
  }

  // 0 to 1: progress of an instrument over the region.
  double crossing(double time) const {
    const CrossingConfig& c = config_.crossing;
    if (!(c.period > 0.0)) return 0.0;
    const double since = std::fmod(time, c.period) - 0.5 * c.period;  // not at the start
    return since < 0.0 || since > c.duration ? 0.0 : std::sin(M_PI * since / c.duration);
  }

  // Distance [px] of the corner nearest to the image's border from it; negative if a corner is outside, or if the
  // region is not visible.
  double nearestToBorder(const geometry::Quadrilateral& corners) const {
    if (!geometry::isConvex(corners)) return -1.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : corners) {
      nearest = std::min({nearest, p.x(), p.y(), config_.width - 1.0 - p.x(), config_.height - 1.0 - p.y()});
    }
    return nearest;
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
    const Eigen::Matrix3d h = seenHomography(time);
    const Eigen::Vector2d centre =
        geometry::apply(geometry::pixelsFromNormalised(h, config_.camera), config_.roi.centre());
    s.u = centre.x();
    s.v = centre.y();
    s.worst_corner = nearestToBorder(cornersAt(time, config_.roi));
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
    s.state = output.state;
    return s;
  }

  SimulationConfig config_;
  Eigen::Matrix3d shaft_R_camera_;
  servo::ControllerConfig setup_;
  servo::PointsError points_error_;
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
  Eigen::Matrix3d picture_;  // takes the correct picture to the one shown, normalised coordinates
  Eigen::Vector4d signs_;
  std::optional<Eigen::Matrix3d> frozen_;            // homography of a frozen picture
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
