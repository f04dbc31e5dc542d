#include "laparoscope_servo/model/cylinder_pose.h"

#include <cmath>

namespace laparoscope_servo::model {

namespace {

struct Axis {
  Eigen::Vector3d direction;  // of length 1
  Eigen::Vector3d foot;       // nearest to the camera
};

// The plane through the camera's centre and the line touches the cylinder; its unit normal points away from it.
Eigen::Vector3d planeNormal(const geometry::PinholeCamera& camera, double rho, double theta) {
  const double c = std::cos(theta), s = std::sin(theta);
  return Eigen::Vector3d(camera.fx * c, camera.fy * s, camera.cx * c + camera.cy * s - rho).normalized();  // K' l
}

// The axis lies in the direction that both planes share, at a distance of the radius inside of either: n_i . p = -r.
std::optional<Axis> axisOf(const Eigen::Vector3d& n0, const Eigen::Vector3d& n1, double radius) {
  const Eigen::Vector3d along = n0.cross(n1);
  const double sine = along.norm(), cosine = n0.dot(n1);
  if (!(sine > 1e-6)) return std::nullopt;
  // p = -r (n0 + n1) / (1 + n0 . n1)
  return Axis{along / sine, -radius / (1.0 + cosine) * (n0 + n1)};
}

}  // namespace

std::optional<CylinderPose> cylinderPose(const geometry::PinholeCamera& camera, double radius,
                                         const std::array<OutlineLine, 2>& lines,
                                         const std::optional<Eigen::Vector2d>& tip, double tip_variance) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  if (!(radius > 0.0) || !camera.error().empty()) return std::nullopt;

  // The parameters that are known with a covariance: rho and theta of both lines, and the tip along the image's axis.
  Eigen::Matrix<double, 5, 1> values;
  values << lines[0].rho, lines[0].theta, lines[1].rho, lines[1].theta, 0.0;
  Eigen::Matrix<double, 5, 5> known = Eigen::Matrix<double, 5, 5>::Zero();
  known.topLeftCorner<2, 2>() = lines[0].covariance;
  known.block<2, 2>(2, 2) = lines[1].covariance;
  known(4, 4) = tip_variance;
  const Eigen::Vector2d n0(std::cos(values[1]), std::sin(values[1])), n1(std::cos(values[3]), std::sin(values[3]));
  const Eigen::Vector2d image_axis = (Eigen::Vector2d(-n1.y(), n1.x()) - Eigen::Vector2d(-n0.y(), n0.x())).normalized();

  const auto solve = [&](const Eigen::Matrix<double, 5, 1>& v) -> std::optional<Vector6> {
    const auto axis = axisOf(planeNormal(camera, v[0], v[1]), planeNormal(camera, v[2], v[3]), radius);
    if (!axis) return std::nullopt;
    Vector6 result;
    result << axis->foot, axis->direction;
    if (!tip) return result;
    const Eigen::Vector2d p = *tip + v[4] * image_axis;
    const Eigen::Vector3d ray((p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy, 1.0);
    // The point of the axis nearest to the tip's ray; d is perpendicular to the foot.
    const double rd = ray.dot(axis->direction), rr = ray.squaredNorm(), rf = ray.dot(axis->foot);
    const double divisor = rr - rd * rd;
    if (!(divisor > 1e-9 * rr)) return std::nullopt;
    result.head<3>() += rf * rd / divisor * axis->direction;
    return result;
  };

  const auto here = solve(values);
  if (!here || !here->allFinite()) return std::nullopt;
  CylinderPose pose;
  pose.point = here->head<3>();
  pose.direction = here->tail<3>();
  // In the image the direction is that of image_axis.
  const Eigen::Vector3d q = pose.point;
  if (!(q.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d flow((pose.direction.x() - pose.direction.z() * q.x() / q.z()) * camera.fx,
                             (pose.direction.y() - pose.direction.z() * q.y() / q.z()) * camera.fy);
  const double sign = flow.dot(image_axis) < 0.0 ? -1.0 : 1.0;
  pose.direction *= sign;

  // Derivatives by central differences; the step is far below what an edge is known to.
  Eigen::Matrix<double, 6, 5> jacobian;
  constexpr double kSteps[5] = {1e-3, 1e-6, 1e-3, 1e-6, 1e-3};  // px, rad
  for (int k = 0; k < 5; ++k) {
    Eigen::Matrix<double, 5, 1> more = values, less = values;
    more[k] += kSteps[k];
    less[k] -= kSteps[k];
    const auto ahead = solve(more), behind = solve(less);
    if (!ahead || !behind) return std::nullopt;
    const Vector6 change = (*ahead - *behind) / (2.0 * kSteps[k]);
    // A change of the direction is a rotation d x d'.
    jacobian.col(k) << change.head<3>(), pose.direction.cross(Eigen::Vector3d(sign * change.tail<3>()));
  }
  pose.covariance = jacobian * known * jacobian.transpose();
  const Eigen::Matrix3d open = CylinderPose::kOpen * pose.direction * pose.direction.transpose();
  pose.covariance.bottomRightCorner<3, 3>() += open;
  if (!tip) pose.covariance.topLeftCorner<3, 3>() += open;
  return pose.covariance.allFinite() ? std::optional<CylinderPose>(pose) : std::nullopt;
}

}  // namespace laparoscope_servo::model
