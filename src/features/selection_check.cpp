#include "laparoscope_servo/features/selection_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

namespace laparoscope_servo::features {

namespace {

Eigen::AlignedBox2d boxOf(const SelectedFeature& selected) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : selected.points) box.extend(point);
  if (selected.ellipse) {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(std::max(selected.ellipse->a, selected.ellipse->b));
    box.extend(selected.ellipse->centre - reach);
    box.extend(selected.ellipse->centre + reach);
  }
  return box;
}

}  // namespace

void checkInImage(const SelectedFeature& selected, const cv::Size& size) {
  const Eigen::AlignedBox2d box = boxOf(selected);
  if (box.isEmpty()) return;  // all of the image
  if (box.intersects({Eigen::Vector2d::Zero(), Eigen::Vector2d(size.width - 1.0, size.height - 1.0)})) return;
  std::ostringstream text;
  text << kindName(selected.kind) << " between (" << box.min().x() << ", " << box.min().y() << ") and ("
       << box.max().x() << ", " << box.max().y() << "), expected a part of it in the image of " << size.width << " x "
       << size.height << " px";
  throw std::invalid_argument(text.str());
}

}  // namespace laparoscope_servo::features
