#include "tracking/contour_texture/outline.h"

#include "laparoscope_servo/geometry/homography.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kBend = 4;  // slots either side, over which curvature is measured

Eigen::Vector2d across(const Eigen::Vector2d& tangent) {
  return Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
}

}  // namespace

Outline::Outline(const features::Spline& contour, const Eigen::Matrix3d& normalisation) : length_(contour.length()) {
  std::vector<features::Site> sites;
  contour.sites(1e-3, kSlots, sites);
  for (const features::Site& site : sites) {
    const Eigen::Vector2d tangent(-site.normal.y(), site.normal.x());
    places_.push_back(
        {site.point, tangent, pointJacobian(geometry::apply(normalisation, site.point)) / normalisation(0, 0)});
  }
}

features::Site Outline::site(const Eigen::Matrix3d& g, int slot) const {
  const auto at = [&](int s) -> const Place& { return places_[static_cast<std::size_t>((s + kSlots) % kSlots)]; };
  const Place& place = at(slot);
  const Eigen::Matrix2d derivative = geometry::derivative(g, place.point);
  features::Site site;
  site.point = geometry::apply(g, place.point);
  site.normal = across(derivative * place.tangent);
  const Eigen::Vector2d before = geometry::apply(g, at(slot - kBend).point);
  const Eigen::Vector2d after = geometry::apply(g, at(slot + kBend).point);
  const Eigen::Vector2d slope = 0.5 * (after - before), bend = after - 2.0 * site.point + before;
  const double speed = slope.norm();
  site.curvature = (slope.x() * bend.y() - slope.y() * bend.x()) / (speed * speed * speed);
  site.count = 8;
  const Eigen::Matrix<double, 1, 8> row = site.normal.transpose() * derivative * place.step;
  for (int k = 0; k < 8; ++k) site.jacobian[static_cast<std::size_t>(k)] = row[k];
  site.slot = slot;
  return site;
}

void Outline::sites(const Eigen::Matrix3d& g, double spacing, int most, std::vector<features::Site>& result) const {
  int count = kSlots;
  while (count > 25 && (count > most || length_ / count < 0.7 * spacing)) count /= 2;
  const int stride = kSlots / count;
  result.clear();
  for (int i = 0; i < count; ++i) result.push_back(site(g, i * stride + stride / 2));
}

}  // namespace laparoscope_servo::tracking
