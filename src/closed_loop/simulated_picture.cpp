#include "closed_loop/simulated_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/servo/place_error.h"
#include "laparoscope_servo/servo/position_error.h"
#include "laparoscope_servo/servo/view_region.h"

namespace laparoscope_servo::closed_loop {

namespace {

constexpr int kPointsAlong = 6;         // points in a row and in a column of the region
constexpr double kEnoughInView = 0.25;  // share of the reference image, as AnchoredMotion needs it

Eigen::Matrix3d pictureOf(const PictureConfig& config) {
  Eigen::Vector3d mirror = Eigen::Vector3d::Ones();
  if (config.mirror == "left_right") mirror.x() = -1.0;
  if (config.mirror == "up_down") mirror.y() = -1.0;
  return geometry::so3Exp({0.0, 0.0, config.roll}) * mirror.asDiagonal();
}

}  // namespace

SimulatedPicture::SimulatedPicture(const SimulationConfig& config, const servo::ControllerConfig& control,
                                   const Eigen::Matrix3d& camera_R_shaft)
    : config_(config),
      control_(control),
      camera_R_shaft_(camera_R_shaft),
      points_error_(control.points, control.features.desired_depth),
      picture_(pictureOf(config.picture)) {}

void SimulatedPicture::freeze(const Eigen::Matrix3d& h) {
  frozen_ = h;
}

Eigen::Matrix3d SimulatedPicture::seen(const Eigen::Matrix3d& h) const {
  return picture_ * (frozen_ ? *frozen_ : h) * picture_.transpose();
}

servo::TaskErrorInput SimulatedPicture::expose(servo::Task task, double time, const Eigen::Matrix3d& h, double d2,
                                               Noise& noise) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.valid = false;
  const double covered = crossing(time);
  input.corner_error = config_.corner_noise * (1.0 + covered * (config_.crossing.noise - 1.0));
  input.visible_fraction = 1.0 - covered * config_.crossing.cover;
  const Eigen::Matrix3d g = pixels(h);
  switch (task) {
    case servo::Task::kCentreTip:
      exposePlace(g, {control_.centre_tip.x, control_.centre_tip.y}, input, noise);
      break;
    case servo::Task::kFollow:
      exposePlace(g, {control_.follow.x, control_.follow.y}, input, noise);
      break;
    case servo::Task::kPoints:
      exposePoints(g, d2, input, noise);
      break;
    case servo::Task::kPosition:
      exposePosition(g, d2, input, noise);
      break;
    case servo::Task::kParallel:
      exposeView(h, input, noise);
      break;
    default:
      exposeRegion(g, task == servo::Task::kStabilise, input, noise);
  }
  return input;
}

double SimulatedPicture::nearestToBorder(const Eigen::Matrix3d& h) const {
  return nearestToBorder(geometry::apply(pixels(h), config_.roi.corners()));
}

bool SimulatedPicture::isInImage(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= config_.width - 1.0 && pixel.y() <= config_.height - 1.0;
}

Eigen::Vector2d SimulatedPicture::normalised(const Eigen::Vector2d& pixel) const {
  return (config_.camera.inverseMatrix() * pixel.homogeneous()).head<2>();
}

// Of the picture, with its faults.
Eigen::Matrix3d SimulatedPicture::pixels(const Eigen::Matrix3d& h) const {
  return geometry::pixelsFromNormalised(seen(h), config_.camera);
}

double SimulatedPicture::nearestToBorder(const geometry::Quadrilateral& corners) const {
  if (!geometry::isConvex(corners)) return -1.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : corners) {
    nearest = std::min({nearest, p.x(), p.y(), config_.width - 1.0 - p.x(), config_.height - 1.0 - p.y()});
  }
  return nearest;
}

// Share of the reference image that is in view.
double SimulatedPicture::referenceInView(const Eigen::Matrix3d& g) const {
  constexpr int kAlong = 10;
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
double SimulatedPicture::crossing(double time) const {
  const CrossingConfig& c = config_.crossing;
  if (!(c.period > 0.0)) return 0.0;
  const double since = std::fmod(time, c.period) - 0.5 * c.period;  // not at the start
  return since < 0.0 || since > c.duration ? 0.0 : std::sin(M_PI * since / c.duration);
}

// A tip, or the middle of an object.
void SimulatedPicture::exposePlace(const Eigen::Matrix3d& g, const Eigen::Vector2d& desired,
                                   servo::TaskErrorInput& input, Noise& noise) const {
  const Eigen::Vector2d place = geometry::apply(g, config_.roi.centre()) + noise.draw(input.corner_error);
  input.valid = isInImage(place);
  input.error = servo::placeError(normalised(place), desired);
}

// Points of a grid about the region's centre. Those astray stay where they were in the reference image, whatever the
// scope does.
void SimulatedPicture::exposePoints(const Eigen::Matrix3d& g, double d2, servo::TaskErrorInput& input, Noise& noise) {
  std::vector<servo::PointTask> points;
  int astray = 0;
  for (int k = 0; k < kPointsAlong * kPointsAlong; ++k) {
    const Eigen::Vector2d cell((k % kPointsAlong + 0.5) / kPointsAlong, (k / kPointsAlong + 0.5) / kPointsAlong);
    const Eigen::Vector2d reference(config_.roi.x + cell.x() * config_.roi.width,
                                    config_.roi.y + cell.y() * config_.roi.height);
    const bool is_astray = astray < config_.points_astray * (k + 1);
    astray += is_astray ? 1 : 0;
    const Eigen::Vector2d place =
        (is_astray ? reference : geometry::apply(g, reference)) + noise.draw(input.corner_error);
    servo::PointTask& point = points.emplace_back();
    point.point = normalised(place);
    point.desired = normalised(reference);
    point.weight = isInImage(place) ? 1.0 : 0.0;
  }
  const servo::PointsSeen seen = points_error_.from(points, normalised(config_.roi.centre()), {camera_R_shaft_, d2});
  input.valid = seen.is_known;
  input.error = seen.error;
  input.corner_error = config_.camera.fx * seen.stddev;
}

// The homography of a region by its corners, normalised. The whole view is compared with the anchor by what of it is in
// the image; a region has to be in it.
std::optional<Eigen::Matrix3d> SimulatedPicture::measured(const Eigen::Matrix3d& g, const geometry::Rectangle& region,
                                                          bool whole, double sigma, Noise& noise) const {
  geometry::Quadrilateral corners = geometry::apply(g, region.corners());
  if (!(whole ? referenceInView(g) >= kEnoughInView : nearestToBorder(corners) >= 0.0)) return std::nullopt;
  for (Eigen::Vector2d& corner : corners) corner += noise.draw(sigma);
  return geometry::normalisedFromPixels(geometry::fromCorners(region.corners(), corners), config_.camera);
}

// As AnchoredMotion does it: by the reference image where enough of it is in view, otherwise from image to image.
void SimulatedPicture::exposeView(const Eigen::Matrix3d& h, servo::TaskErrorInput& input, Noise& noise) {
  const geometry::Rectangle region = servo::viewRegion(config_.width, config_.height);
  const Eigen::Matrix3d g = pixels(h);
  const bool is_anchored = !shown_before_ || referenceInView(g) >= kEnoughInView;
  const Eigen::Matrix3d exact = is_anchored ? g : Eigen::Matrix3d(g * shown_before_->inverse());
  geometry::Quadrilateral corners = geometry::apply(exact, region.corners());
  for (Eigen::Vector2d& corner : corners) corner += noise.draw(is_anchored ? input.corner_error : config_.step_noise);
  const Eigen::Matrix3d noisy = geometry::fromCorners(region.corners(), corners);
  followed_ = is_anchored ? noisy : Eigen::Matrix3d(noisy * followed_);
  shown_before_ = g;
  servo::ViewMotion motion;
  motion.h = geometry::normalisedFromPixels(followed_, config_.camera);
  motion.corners = region.corners();
  for (Eigen::Vector2d& corner : motion.corners) corner = normalised(corner);
  motion.error = input.corner_error / config_.camera.fx;
  input.error = servo::taskError(motion.h, region, config_.camera);
  input.motion = motion;
  input.valid = true;
}

void SimulatedPicture::exposeRegion(const Eigen::Matrix3d& g, bool whole, servo::TaskErrorInput& input,
                                    Noise& noise) const {
  const geometry::Rectangle region = whole ? servo::viewRegion(config_.width, config_.height) : config_.roi;
  const std::optional<Eigen::Matrix3d> h = measured(g, region, whole, input.corner_error, noise);
  if (!h) return;
  input.error = servo::taskError(*h, region, config_.camera);
  input.valid = true;
}

void SimulatedPicture::exposePosition(const Eigen::Matrix3d& g, double d2, servo::TaskErrorInput& input,
                                      Noise& noise) const {
  const std::optional<Eigen::Matrix3d> h = measured(g, config_.roi, false, input.corner_error, noise);
  if (!h) return;
  const servo::PositionSeen seen = servo::positionError(*h, normalised(config_.roi.centre()).homogeneous(),
                                                        {camera_R_shaft_, d2}, control_.features.desired_depth);
  input.valid = seen.is_known;
  input.error = seen.error;
}

}  // namespace laparoscope_servo::closed_loop
