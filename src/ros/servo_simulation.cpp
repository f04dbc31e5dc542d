#include "laparoscope_servo/ros/servo_simulation.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/ros/controller_conversions.h"
#include "laparoscope_servo/servo/insertion_point.h"
#include "laparoscope_servo/sim/scope_body.h"

namespace laparoscope_servo::skin {

namespace {

constexpr double kStep = 0.001;  // s, of the integration

// Normal noise by Box and Muller: the standard leaves open how std::normal_distribution draws its numbers, and the same
// seed has to give the same run everywhere.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  Eigen::Vector2d draw(double sigma) {
    const double radius = sigma * std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * M_PI * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  double uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }
  std::mt19937 random_;
};

class Loop {
 public:
  Loop(const ControllerNodeConfig& controller, const SimulationConfig& config, unsigned seed)
      : config_(config),
        controller_(controller.control),
        actuator_(config.robot),
        noise_(seed),
        body_(startPose(config), {0.0, 0.0, -config.depth}, config.scope_length) {
    if (!corners()) {
      throw std::invalid_argument("the start pose does not see the region of interest");
    }
  }

  void expose(double time) {
    servo::TaskErrorInput input;
    input.problem.clear();
    input.valid = false;
    input.visible_fraction = 1.0;
    input.corner_error = config_.corner_noise;
    if (std::optional<geometry::Quadrilateral> seen = corners()) {
      for (Eigen::Vector2d& corner : *seen) corner += noise_.draw(config_.corner_noise);
      const Eigen::Matrix3d g = geometry::fromCorners(config_.roi.corners(), *seen);
      input.error = servo::taskError(geometry::normalisedFromPixels(g, config_.camera), config_.roi, config_.camera);
      input.valid = true;
    }
    images_.emplace_back(time, input);
  }

  SimulationSample control(double time) {
    servo::ControllerInput input;
    input.time = time;
    while (!images_.empty() && images_.front().first + config_.image_delay <= time + 1e-9) {
      latest_ = images_.front();
      images_.pop_front();
    }
    input.task_error = latest_.second;
    input.task_error.age = input.task_error.image_age = std::max(0.0, time - latest_.first);
    input.robot = {"", true, 0.0};
    input.dead_man = {true, 0.0};
    input.depth.problem.clear();
    input.depth.d2 = believedDepth();
    input.depth.lateral_offset = body_.lateralOffset();
    if (!engaged_once_) engaged_once_ = controller_.engage(input).empty();
    const servo::ControllerOutput output = controller_.update(input);
    actuator_.command(time, output.command.vector());
    return sample(time, output);
  }

  // The midpoint rule: d1 changes while the scope is pushed in.
  void move(double time) {
    const servo::ScopeVelocity executed = servo::ScopeVelocity::fromVector(actuator_.velocity(time));
    sim::ScopeBody halfway = body_;
    halfway.move(endEffectorTwist(executed, believedDepth()), 0.5 * kStep);
    body_.move(endEffectorTwist(executed, config_.believed_depth_factor * halfway.depth()), kStep);
  }

 private:
  static Eigen::Isometry3d startPose(const SimulationConfig& config) {
    const Eigen::Isometry3d world_T_insertion_point(Eigen::Translation3d(0.0, 0.0, -config.depth));
    Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
    turned.linear() =
        geometry::so3Exp({config.start.tilt, config.start.pan, 0.0}) * geometry::so3Exp({0.0, 0.0, config.start.spin});
    return world_T_insertion_point * turned * Eigen::Translation3d(0.0, 0.0, config.depth + config.start.insertion);
  }

  Eigen::Matrix3d trueHomography() const {
    const Eigen::Vector3d normal =
        geometry::so3Exp({config_.tissue_slant_x, config_.tissue_slant_y, 0.0}) * Eigen::Vector3d::UnitZ();
    // The plane meets the reference camera's axis at tissue_distance.
    return geometry::fromPlane(body_.pose().inverse(), normal, config_.tissue_distance * normal.z());
  }

  // The ROI's corners, when they are all in the image.
  std::optional<geometry::Quadrilateral> corners() const {
    const Eigen::Matrix3d g = geometry::pixelsFromNormalised(trueHomography(), config_.camera);
    const geometry::Quadrilateral seen = geometry::apply(g, config_.roi.corners());
    if (!geometry::isConvex(seen)) return std::nullopt;
    for (const Eigen::Vector2d& p : seen) {
      if (!(p.x() >= 0.0 && p.x() <= config_.width - 1.0 && p.y() >= 0.0 && p.y() <= config_.height - 1.0)) {
        return std::nullopt;
      }
    }
    return seen;
  }

  double believedDepth() const { return config_.believed_depth_factor * body_.depth(); }

  geometry::Vector6d endEffectorTwist(const servo::ScopeVelocity& velocity, double believed_depth) const {
    return servo::endEffectorTwist(velocity, body_.length() - believed_depth);  // eq. (12)
  }

  SimulationSample sample(double time, const servo::ControllerOutput& output) {
    SimulationSample s;
    s.t = time;
    s.command = output.command;
    const Eigen::Matrix3d h = trueHomography();
    const Eigen::Vector2d centre =
        geometry::apply(geometry::pixelsFromNormalised(h, config_.camera), config_.roi.centre());
    s.u = centre.x();
    s.v = centre.y();
    try {
      const servo::TaskError error = servo::taskError(h, config_.roi, config_.camera);
      s.log_depth = error.log_depth;
      s.alpha = error.alpha;
    } catch (const std::invalid_argument&) {  // the tissue is behind the camera
      s.log_depth = s.alpha = std::nan("");
    }
    s.d2 = body_.depth();
    s.d1 = body_.length() - s.d2;
    const auto executed = servo::ScopeVelocity::fromVector(actuator_.velocity(time));
    const geometry::Vector6d camera = body_.cameraTwist(endEffectorTwist(executed, believedDepth()));
    s.lateral_speed = servo::twistAtInsertionPoint(camera, s.d2).head<2>().norm();  // eq. (9)
    s.lateral_offset = body_.lateralOffset();
    s.state = toMessage(output).state;
    return s;
  }

  SimulationConfig config_;
  servo::Controller controller_;
  sim::ScopeActuator actuator_;
  Noise noise_;
  sim::ScopeBody body_;
  std::deque<std::pair<double, servo::TaskErrorInput>> images_;
  std::pair<double, servo::TaskErrorInput> latest_{0.0, servo::TaskErrorInput()};
  bool engaged_once_ = false;
};

}  // namespace

std::vector<SimulationSample> simulate(const ControllerNodeConfig& controller, const SimulationConfig& config,
                                       unsigned seed, double duration) {
  Loop loop(controller, config, seed);
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

}  // namespace laparoscope_servo::skin
