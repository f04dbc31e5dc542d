#include "laparoscope_servo/image/lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::image {

namespace {

constexpr double kLargestAngle = 88.0 * M_PI / 180.0;  // rad, from the axis; a plane has no pixel at 90 degrees
constexpr int kFieldSteps = 880;
constexpr int kAzimuths = 8;
constexpr int kIterations = 30;
constexpr double kSolved = 1e-9;   // of the focal length
constexpr int kMapStep = 8;        // px
constexpr float kNowhere = -1e6f;  // px

void check(const LensParameters& p) {
  std::ostringstream error;
  for (const double value : p.coefficients) {
    if (!std::isfinite(value)) error << "distortion coefficient " << value << ", expected finite";
    if (!error.str().empty()) break;
  }
  if (error.str().empty() && !p.raw.error().empty()) error << "K: " << p.raw.error();
  if (error.str().empty() && !p.rectified.error().empty()) error << "P: " << p.rectified.error();
  const Eigen::Matrix3d off = p.rotation * p.rotation.transpose() - Eigen::Matrix3d::Identity();
  if (error.str().empty() && !(off.cwiseAbs().maxCoeff() < 1e-3 && p.rotation.determinant() > 0.0)) {
    error << "R: R R' differs from the identity by up to " << off.cwiseAbs().maxCoeff() << ", expected a rotation";
  }
  if (!error.str().empty()) throw std::invalid_argument(error.str());
}

class Bounds {
 public:
  void add(const Eigen::Vector2d& p) {
    finite_ = finite_ && p.allFinite();
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  // Empty when nothing was added, or a point that is not finite.
  cv::Rect box(double margin) const {
    if (!finite_ || !(low_.x() <= high_.x())) return {};
    // Far outside any image; keeps the conversion to int defined.
    const auto bounded = [](double x) { return static_cast<int>(std::clamp(x, -1e6, 1e6)); };
    const cv::Point first(bounded(std::floor(low_.x() - margin)), bounded(std::floor(low_.y() - margin)));
    const cv::Point last(bounded(std::ceil(high_.x() + margin)), bounded(std::ceil(high_.y() + margin)));
    return {first, last + cv::Point(1, 1)};
  }

 private:
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high_ = -low_;
  bool finite_ = true;
};

}  // namespace

Lens::Lens(const LensParameters& parameters) : parameters_(parameters) {
  check(parameters);
  // Some files hold R with few digits; the inverse, unlike the transpose, undoes it exactly.
  rays_ = parameters.rotation.inverse() * parameters.rectified.inverseMatrix();
  rectified_from_rays_ = parameters.rectified.matrix() * parameters.rotation;
  field_ = findField();
  if (!(field_ > 0.0))
    throw std::invalid_argument("distortion model is not one to one on the axis, expected coefficients that are");
}

// The factor by which a point at squared distance q from the axis is moved radially.
double Lens::radial(double q) const {
  const std::array<double, 8>& c = parameters_.coefficients;
  if (parameters_.distortion == Distortion::kEquidistant) {
    const double r = std::sqrt(q);
    const double angle = std::atan(r);
    const double a2 = angle * angle;
    const double distorted = angle * (1.0 + a2 * (c[0] + a2 * (c[1] + a2 * (c[2] + a2 * c[3]))));
    return r > 1e-9 ? distorted / r : 1.0;
  }
  return (1.0 + q * (c[0] + q * (c[1] + q * c[4]))) / (1.0 + q * (c[5] + q * (c[6] + q * c[7])));
}

Eigen::Vector2d Lens::distort(const Eigen::Vector2d& point) const {
  const double q = point.squaredNorm();
  const Eigen::Vector2d moved = radial(q) * point;
  if (parameters_.distortion == Distortion::kEquidistant) return moved;
  const double x = point.x();
  const double y = point.y();
  const double p1 = parameters_.coefficients[2];
  const double p2 = parameters_.coefficients[3];
  return moved + Eigen::Vector2d(2.0 * p1 * x * y + p2 * (q + 2.0 * x * x), p1 * (q + 2.0 * y * y) + 2.0 * p2 * x * y);
}

Eigen::Matrix2d Lens::derivative(const Eigen::Vector2d& point) const {
  const double h = 1e-6 * (1.0 + point.norm());
  Eigen::Matrix2d j;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(k);
    j.col(k) = (distort(point + step) - distort(point - step)) / (2.0 * h);
  }
  return j;
}

// Searches outwards until the map is no longer one to one in some direction, or has passed a pole.
double Lens::findField() const {
  double field = 0.0;
  for (int step = 0; step <= kFieldSteps; ++step) {
    const double r = std::tan(step * kLargestAngle / kFieldSteps);
    if (!(radial(r * r) > 0.0)) return field;
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * M_PI * k / kAzimuths;
      const Eigen::Matrix2d j = derivative(r * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)));
      if (!(j.determinant() > 0.0) || !j.allFinite()) return field;
    }
    field = r * r;
  }
  return field;
}

std::optional<Eigen::Vector2d> Lens::toRaw(const Eigen::Vector2d& rectified) const {
  const Eigen::Vector3d ray = rays_ * rectified.homogeneous();
  if (!(ray.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d point = ray.head<2>() / ray.z();
  if (!(point.squaredNorm() < field_)) return std::nullopt;
  const Eigen::Vector2d moved = distort(point);
  const geometry::PinholeCamera& raw = parameters_.raw;
  return Eigen::Vector2d(raw.fx * moved.x() + raw.cx, raw.fy * moved.y() + raw.cy);
}

// Inverse of the radial model, without the tangential terms. The field's radius if there is no solution in the field.
double Lens::undistortedRadius(double distorted) const {
  double low = 0.0;
  double high = std::sqrt(field_);
  if (!(high * radial(high * high) > distorted)) return high;
  for (int k = 0; k < kIterations; ++k) {
    const double middle = 0.5 * (low + high);
    (middle * radial(middle * middle) < distorted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<Eigen::Vector2d> Lens::toRectified(const Eigen::Vector2d& raw) const {
  const geometry::PinholeCamera& camera = parameters_.raw;
  const Eigen::Vector2d seen((raw.x() - camera.cx) / camera.fx, (raw.y() - camera.cy) / camera.fy);
  const double distance = seen.norm();
  if (!std::isfinite(distance)) return std::nullopt;
  Eigen::Vector2d point = distance > 0.0 ? Eigen::Vector2d(seen * (undistortedRadius(distance) / distance)) : seen;
  double left = 0.0;
  for (int k = 0; k < kIterations; ++k) {
    const Eigen::Vector2d residual = distort(point) - seen;
    left = residual.norm();
    if (left < kSolved * 1e-3) break;
    point -= derivative(point).inverse() * residual;
    if (!(point.squaredNorm() < field_)) return std::nullopt;  // also for NaN
  }
  if (!(left < kSolved) || !(point.squaredNorm() < field_)) return std::nullopt;
  const Eigen::Vector3d p = rectified_from_rays_ * point.homogeneous();
  if (!(p.z() > 0.0)) return std::nullopt;
  return Eigen::Vector2d(p.head<2>() / p.z());
}

LensLoop Lens::loop(const RawWindow& window) const {
  const std::array<double, 8>& c = parameters_.coefficients;
  LensLoop result;
  result.equidistant = parameters_.distortion == Distortion::kEquidistant;
  const std::array<int, 6> order =
      result.equidistant ? std::array<int, 6>{0, 1, 2, 3, 4, 5} : std::array<int, 6>{0, 1, 4, 5, 6, 7};
  for (int k = 0; k < 6; ++k) result.k[k] = static_cast<float>(c[order[k]]);
  if (!result.equidistant) {
    result.p1 = static_cast<float>(c[2]);
    result.p2 = static_cast<float>(c[3]);
  }
  const geometry::PinholeCamera& raw = parameters_.raw;
  result.fx = static_cast<float>(raw.fx / window.scale);
  result.fy = static_cast<float>(raw.fy / window.scale);
  result.cx = static_cast<float>((raw.cx - window.origin.x) / window.scale);
  result.cy = static_cast<float>((raw.cy - window.origin.y) / window.scale);
  result.field = static_cast<float>(field_);
  return result;
}

bool operator==(const Lens& a, const Lens& b) {
  const LensParameters& p = a.parameters();
  const LensParameters& q = b.parameters();
  return p.distortion == q.distortion && p.coefficients == q.coefficients && p.raw == q.raw &&
         p.rectified == q.rectified && p.rotation == q.rotation;
}

cv::Rect rawBox(const Lens& lens, const geometry::Quadrilateral& rectified, double margin) {
  // Samples the whole quadrilateral, since the lens bends its edges and the field may end within it.
  constexpr int kSteps = 8;
  Bounds bounds;
  for (int j = 0; j <= kSteps; ++j) {
    const double down = static_cast<double>(j) / kSteps;
    const Eigen::Vector2d left = rectified[0] + down * (rectified[3] - rectified[0]);
    const Eigen::Vector2d right = rectified[1] + down * (rectified[2] - rectified[1]);
    for (int i = 0; i <= kSteps; ++i) {
      const auto raw = lens.toRaw(left + static_cast<double>(i) / kSteps * (right - left));
      if (raw) bounds.add(*raw);
    }
  }
  return bounds.box(margin);
}

cv::Rect seenBox(const Lens* lens, const geometry::Quadrilateral& corners, double margin) {
  if (lens != nullptr) return rawBox(*lens, corners, margin);
  Bounds bounds;
  for (const Eigen::Vector2d& corner : corners) bounds.add(corner);
  return bounds.box(margin);
}

cv::Rect rectifiedBox(const Lens& lens, const cv::Size& size) {
  constexpr int kSteps = 16;
  const Eigen::Array2d extent(size.width, size.height);
  Bounds bounds;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const auto p =
          lens.toRectified(Eigen::Vector2d((size.width - 1.0) * i / kSteps, (size.height - 1.0) * j / kSteps));
      if (p) bounds.add(p->array().max(-0.5 * extent).min(1.5 * extent).matrix());
    }
  }
  return bounds.box(0.0);
}

cv::Mat2f rectifiedMap(const Lens& lens, const cv::Rect& box) {
  if (box.empty()) return {};
  const cv::Size nodes((box.width - 1) / kMapStep + 2, (box.height - 1) / kMapStep + 2);
  cv::Mat2f coarse(nodes);
  for (int j = 0; j < nodes.height; ++j) {
    for (int i = 0; i < nodes.width; ++i) {
      const auto p = lens.toRectified(Eigen::Vector2d(box.x + i * kMapStep, box.y + j * kMapStep));
      coarse(j, i) = p ? cv::Vec2f(static_cast<float>(p->x()), static_cast<float>(p->y())) : cv::Vec2f(NAN, NAN);
    }
  }
  // Interpolates linearly between the nodes; cells with a node without a rectified pixel have none either.
  cv::Mat2f map(box.size());
  for (int j = 0; j < box.height; ++j) {
    const float down = static_cast<float>(j % kMapStep) / kMapStep;
    const cv::Vec2f* above = coarse.ptr<cv::Vec2f>(j / kMapStep);
    const cv::Vec2f* below = coarse.ptr<cv::Vec2f>(j / kMapStep + 1);
    for (int i = 0; i < box.width; ++i) {
      const float right = static_cast<float>(i % kMapStep) / kMapStep;
      const int k = i / kMapStep;
      const cv::Vec2f upper = above[k] * (1.0f - right) + above[k + 1] * right;
      const cv::Vec2f lower = below[k] * (1.0f - right) + below[k + 1] * right;
      const cv::Vec2f p = upper * (1.0f - down) + lower * down;
      map(j, i) = std::isfinite(p[0]) && std::isfinite(p[1]) ? p : cv::Vec2f(kNowhere, kNowhere);
    }
  }
  return map;
}

void drawMask(const cv::Mat1b& mask, const Eigen::Matrix3d& g, const Lens* lens, const cv::Rect& window,
              cv::Mat1b& result) {
  if (lens == nullptr) {
    Eigen::Matrix3d to_window = Eigen::Matrix3d::Identity();
    to_window.topRightCorner<2, 1>() << -window.x, -window.y;
    const Eigen::Matrix3d m = to_window * g;
    const cv::Matx33d warp(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
    cv::warpPerspective(mask, result, warp, window.size(), cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(0));
    return;
  }
  const Eigen::Matrix3f to_mask = g.inverse().cast<float>();
  cv::Mat2f map = rectifiedMap(*lens, window);
  for (cv::Vec2f& p : map) {
    const Eigen::Vector3f q = to_mask * Eigen::Vector3f(p[0], p[1], 1.0f);
    p = q.z() > 0.0f && p[0] > kNowhere ? cv::Vec2f(q.x() / q.z(), q.y() / q.z()) : cv::Vec2f(kNowhere, kNowhere);
  }
  cv::remap(mask, result, map, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(0));
}

}  // namespace laparoscope_servo::image
