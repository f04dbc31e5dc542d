#include "model/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "laparoscope_servo/robust/largest.h"
#include "model/strands.h"

namespace laparoscope_servo::model {

namespace {

constexpr double kNear = 0.01;  // of the centre's depth: nothing nearer is drawn
constexpr int kLeastOfCircle = 8;
constexpr double kLeastDepth = 0.05;  // of the model's radius: where its centre is, at least
constexpr double kTypical = 0.6;      // of the model's radius: how far its surface is from its centre, about

// The part [low, high] of a + t (b - a), t in [low, high], whose coordinate lies in [0, most].
void clip(double a, double b, double most, double& low, double& high) {
  const double slope = b - a;
  if (std::abs(slope) < 1e-9) {
    if (a < 0.0 || a > most) high = low - 1.0;
    return;
  }
  const double s = -a / slope, t = (most - a) / slope;
  low = std::max(low, std::min(s, t));
  high = std::min(high, std::max(s, t));
}

// The rotation by the smallest angle that takes one direction to the other.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

// The share of the way in space at which the image is `s` of the way from begin to end.
double inSpace(double s, double begin_z, double end_z) {
  return s * begin_z / (s * begin_z + (1.0 - s) * end_z);
}

}  // namespace

Eigen::Matrix<double, 2, 6> pointInteraction(const geometry::PinholeCamera& camera, const Eigen::Vector3d& point) {
  const double x = point.x() / point.z(), y = point.y() / point.z(), d = 1.0 / point.z();
  Eigen::Matrix<double, 2, 6> l;
  l << -d, 0.0, x * d, x * y, -(1.0 + x * x), y,  //
      0.0, -d, y * d, 1.0 + y * y, -x * y, -x;
  l.row(0) *= camera.fx;
  l.row(1) *= camera.fy;
  return l;
}

Eigen::Vector2d project(const geometry::PinholeCamera& camera, const Eigen::Vector3d& point) {
  return {camera.fx * point.x() / point.z() + camera.cx, camera.fy * point.y() / point.z() + camera.cy};
}

Outline::Outline(std::shared_ptr<const CadModel> model, const geometry::PinholeCamera& camera, const cv::Size& size,
                 const Eigen::Isometry3d& camera_T_object)
    : model_(std::move(model)), camera_(camera), size_(size), camera_T_object_(camera_T_object), visibility_(*model_) {
  Occluders occluders(*model_);
  look(occluders);
}

void Outline::look(Occluders& occluders, int step) {
  visibility_.update(*model_, camera_T_object_, 0.5 * (camera_.fx + camera_.fy), occluders, step);
}

int Outline::slots() const {
  return Strands(*model_).count() * kStride;
}

// The part of an edge or side that lies in front of the camera and in the image, as shares of its length in space.
bool Outline::clipped(int strand, Eigen::Vector3d& begin, Eigen::Vector3d& end, double& first, double& last) const {
  const Segment line = segment(*model_, camera_T_object_, strand);
  if (!line.exists) return false;
  const double near = kNear * std::abs(centre().z());
  first = 0.0;
  last = 1.0;
  const double rise = line.end.z() - line.begin.z();
  if (line.begin.z() < near && line.end.z() < near) return false;
  if (line.begin.z() < near) first = (near - line.begin.z()) / rise;
  if (line.end.z() < near) last = (near - line.begin.z()) / rise;
  begin = line.at(first);
  end = line.at(last);
  const Eigen::Vector2d a = project(camera_, begin), b = project(camera_, end);
  double low = 0.0, high = 1.0;
  clip(a.x(), b.x(), size_.width - 1.0, low, high);
  clip(a.y(), b.y(), size_.height - 1.0, low, high);
  if (!(low < high)) return false;
  const double from = inSpace(low, begin.z(), end.z()), to = inSpace(high, begin.z(), end.z());
  const double length = last - first;
  last = first + to * length;
  first += from * length;
  begin = line.at(first);
  end = line.at(last);
  return true;
}

double Outline::lengthInImage() const {
  const Strands strands(*model_);
  double sum = 0.0;
  for (int strand = 0; strand < strands.count(); ++strand) {
    int seen = 0;
    for (int k = 0; k < Visibility::kPieces; ++k) seen += visibility_.isSeen(strand, k) ? 1 : 0;
    if (seen == 0) continue;
    double length = 0.0, first = 0.0, last = 1.0;
    Eigen::Vector3d begin, end;
    if (strands.isCircle(strand)) {
      const Circle& circle = model_->circles[static_cast<std::size_t>(strand - strands.edges - strands.sides)];
      length = 2.0 * M_PI * circle.radius * camera_.fx / std::max(1e-9, (camera_T_object_ * circle.centre).z());
    } else if (clipped(strand, begin, end, first, last)) {
      length = (project(camera_, end) - project(camera_, begin)).norm();
    }
    sum += length * std::min(1.0, seen / ((last - first) * Visibility::kPieces));
  }
  return sum;
}

void Outline::addSegment(int strand, double spacing, std::size_t most, std::vector<features::Site>& result) const {
  Eigen::Vector3d begin, end;
  double first = 0.0, last = 1.0;
  if (!clipped(strand, begin, end, first, last)) return;
  const Eigen::Vector2d from = project(camera_, begin), to = project(camera_, end);
  const double length = (to - from).norm();
  const int count = static_cast<int>(length / spacing);
  const Eigen::Vector2d normal(-(to - from).y() / length, (to - from).x() / length);
  for (int i = 0; i < count && result.size() < most; ++i) {
    const double s = (i + 0.5) / count, t = inSpace(s, begin.z(), end.z());
    const int piece =
        std::min(static_cast<int>((first + t * (last - first)) * Visibility::kPieces), Visibility::kPieces - 1);
    if (!visibility_.isSeen(strand, piece)) continue;
    features::Site site;
    site.point = from + s * (to - from);
    site.normal = normal;
    const Eigen::Matrix<double, 1, 6> row = normal.transpose() * pointInteraction(camera_, begin + t * (end - begin));
    site.count = 6;
    for (int k = 0; k < 6; ++k) site.jacobian[static_cast<std::size_t>(k)] = row[k];
    site.slot = strand * kStride + piece;
    result.push_back(site);
  }
}

void Outline::addCircle(int strand, double spacing, std::size_t most, std::vector<features::Site>& result) const {
  const Strands strands(*model_);
  const Circle& circle = model_->circles[static_cast<std::size_t>(strand - strands.edges - strands.sides)];
  const double depth = (camera_T_object_ * circle.centre).z();
  if (!(depth > kNear * std::abs(centre().z()) + circle.radius)) return;
  const int wanted = static_cast<int>(2.0 * M_PI * circle.radius * camera_.fx / depth / spacing);
  const int count = std::max(wanted, kLeastOfCircle);
  for (int i = 0; i < count && result.size() < most; ++i) {
    const double share = (i + 0.5) / count;
    const int piece = static_cast<int>(share * Visibility::kPieces);
    if (!visibility_.isSeen(strand, piece)) continue;
    const CirclePoint c = circlePoint(circle, camera_T_object_, 2.0 * M_PI * share);
    features::Site site;
    site.point = project(camera_, c.point);
    if (!(site.point.x() >= 0.0 && site.point.x() <= size_.width - 1.0 && site.point.y() >= 0.0 &&
          site.point.y() <= size_.height - 1.0)) {
      continue;
    }
    // p = X / Z, and its derivatives by the angle, px.
    const Eigen::Array2d focal(camera_.fx, camera_.fy);
    const Eigen::Array2d p = c.point.head<2>().array() / c.point.z();
    const Eigen::Array2d p1 = (c.first.head<2>().array() - p * c.first.z()) / c.point.z();
    const Eigen::Array2d p2 = (c.second.head<2>().array() - 2.0 * p1 * c.first.z() - p * c.second.z()) / c.point.z();
    const Eigen::Vector2d tangent = focal * p1, bend = focal * p2;
    const double speed = tangent.norm();
    if (!(speed > 1e-9)) continue;
    site.normal = Eigen::Vector2d(tangent.y(), -tangent.x()) / speed;
    // Positive where the curve bends away from the normal.
    site.curvature = -bend.dot(site.normal) / (speed * speed);
    const Eigen::Matrix<double, 1, 6> row = site.normal.transpose() * pointInteraction(camera_, c.point);
    site.count = 6;
    for (int k = 0; k < 6; ++k) site.jacobian[static_cast<std::size_t>(k)] = row[k];
    site.slot = strand * kStride + piece;
    result.push_back(site);
  }
}

void Outline::sites(double spacing, int most, std::vector<features::Site>& result) const {
  result.clear();
  const std::size_t limit = static_cast<std::size_t>(most);
  const double wide = std::max(spacing, lengthInImage() / most);
  const Strands strands(*model_);
  for (int strand = 0; strand < strands.count(); ++strand) {
    if (strands.isCircle(strand)) {
      addCircle(strand, wide, limit, result);
    } else {
      addSegment(strand, wide, limit, result);
    }
  }
}

// The object's origin t moves by -v + t x w, and it turns by -w.
geometry::Matrix6d poseInteraction(const Eigen::Isometry3d& camera_T_object) {
  geometry::Matrix6d result;
  result << -Eigen::Matrix3d::Identity(), geometry::skew(camera_T_object.translation()), Eigen::Matrix3d::Zero(),
      -Eigen::Matrix3d::Identity();
  return result;
}

void Outline::move(const Eigen::VectorXd& step) {
  camera_T_object_ = geometry::se3Exp(geometry::Vector6d(step)).inverse() * camera_T_object_;
}

void Outline::transform(const Eigen::Matrix3d& motion) {
  const Eigen::Vector3d before = centre();
  const double growth = std::sqrt(std::abs(motion.topLeftCorner<2, 2>().determinant()));
  const double turn = std::atan2(motion(1, 0) - motion(0, 1), motion(0, 0) + motion(1, 1));
  const Eigen::Vector2d at = (motion * project(camera_, before).homogeneous()).hnormalized();
  const double depth = before.z() / growth;
  const Eigen::Vector3d after = depth * (camera_.inverseMatrix() * at.homogeneous());
  const Eigen::Matrix3d rotation = rotationBetween(before, after) * geometry::so3Exp(turn * before.normalized());
  Eigen::Isometry3d moved = camera_T_object_;
  moved.linear() = rotation * camera_T_object_.linear();
  moved.translation() = after - moved.linear() * model_->centre;
  camera_T_object_ = moved;
}

// The centre may be off by `range` px in the image, and so may, by size and turn, what is furthest from it. With c the
// centre, the twist moves the centre by -v + c x w and turns the model by -w.
void Outline::known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const {
  const Eigen::Vector3d c = centre();
  const double focal = 0.5 * (camera_.fx + camera_.fy);
  const double across = focal / (c.z() * range), outermost = across * model_->radius;
  geometry::Matrix6d motion;
  motion << -Eigen::Matrix3d::Identity(), geometry::skew(c), Eigen::Matrix3d::Zero(), -Eigen::Matrix3d::Identity();
  geometry::Vector6d stiff;
  stiff << across, across, outermost / c.z(), outermost, outermost, outermost;
  information.noalias() = motion.transpose() * stiff.cwiseAbs2().asDiagonal() * motion;
  // To first order in the step.
  const Outline& there = static_cast<const Outline&>(expected);
  geometry::Vector6d displacement;
  displacement << there.centre() - c,
      geometry::so3Log(there.camera_T_object_.linear() * camera_T_object_.linear().transpose());
  geometry::Matrix6d back;
  back << -Eigen::Matrix3d::Identity(), -geometry::skew(c), Eigen::Matrix3d::Zero(), -Eigen::Matrix3d::Identity();
  mean.noalias() = back * displacement;
}

double Outline::apart(const Eigen::Isometry3d& camera_T_object) const {
  double largest = 0.0;
  for (int k = 0; k < 6; ++k) {
    Eigen::Vector3d point = model_->centre;
    point[k / 2] += (k % 2 == 0 ? 1.0 : -1.0) * kTypical * model_->radius;
    const Eigen::Vector3d here = camera_T_object_ * point, there = camera_T_object * point;
    if (!(here.z() > 0.0 && there.z() > 0.0)) return std::numeric_limits<double>::infinity();
    largest = robust::largest(largest, (project(camera_, here) - project(camera_, there)).norm());
  }
  return largest;
}

bool Outline::isSound() const {
  return camera_T_object_.matrix().allFinite() && centre().z() > kLeastDepth * model_->radius;
}

double Outline::changeFrom(const Eigen::Isometry3d& camera_T_object) const {
  const double depth = std::abs(std::log(centre().z() / (camera_T_object * model_->centre).z()));
  const double turn = Eigen::AngleAxisd(camera_T_object.linear().transpose() * camera_T_object_.linear()).angle();
  return 1.0 + robust::largest(depth, turn);
}

}  // namespace laparoscope_servo::model
