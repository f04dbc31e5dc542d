#include "screen/region_drag.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::screen {

namespace {

constexpr double kClick = 5.0;    // px: a click moves the mouse by less
constexpr double kCorner = 12.0;  // px: distance within which a corner is grabbed

double distance(const QPointF& a, const QPointF& b) {
  return std::max(std::abs(a.x() - b.x()), std::abs(a.y() - b.y()));
}

// The corner opposite to the one that is near.
std::optional<QPointF> oppositeOfCornerAt(const QPointF& at, const QRectF& region) {
  const QPointF corners[] = {region.topLeft(), region.topRight(), region.bottomRight(), region.bottomLeft()};
  for (int k = 0; k < 4; ++k) {
    if (distance(at, corners[k]) <= kCorner) return corners[(k + 2) % 4];
  }
  return std::nullopt;
}

QPointF inside(const QPointF& at, const QRectF& bounds) {
  return {std::clamp(at.x(), bounds.left(), bounds.right()), std::clamp(at.y(), bounds.top(), bounds.bottom())};
}

}  // namespace

RegionDrag::Kind RegionDrag::kindAt(const QPointF& at, const std::optional<QRectF>& present, bool anew) {
  if (!present || anew) return Kind::kDraw;
  if (oppositeOfCornerAt(at, *present)) return Kind::kResize;
  return present->contains(at) ? Kind::kMove : Kind::kDraw;
}

void RegionDrag::press(const QPointF& at, const std::optional<QRectF>& present, const QRectF& bounds, bool anew) {
  kind_ = Kind::kNone;
  far_enough_ = false;
  if (!bounds.contains(at)) return;
  kind_ = kindAt(at, present, anew);
  bounds_ = bounds;
  anchor_ = at_ = at;
  if (kind_ == Kind::kMove) start_ = *present;
  if (kind_ == Kind::kResize) anchor_ = *oppositeOfCornerAt(at, *present);
  press_ = at;
}

void RegionDrag::move(const QPointF& at) {
  if (!isActive()) return;
  at_ = inside(at, bounds_);
  far_enough_ = far_enough_ || distance(at_, press_) >= kClick;
}

std::optional<QRectF> RegionDrag::shown() const {
  if (!isActive() || !far_enough_) return std::nullopt;
  if (kind_ != Kind::kMove) return QRectF(anchor_, at_).normalized();
  QRectF moved = start_.translated(at_ - anchor_);
  moved.moveLeft(std::clamp(moved.left(), bounds_.left(), std::max(bounds_.left(), bounds_.right() - moved.width())));
  moved.moveTop(std::clamp(moved.top(), bounds_.top(), std::max(bounds_.top(), bounds_.bottom() - moved.height())));
  return moved;
}

std::optional<QRectF> RegionDrag::release(const QPointF& at) {
  move(at);
  const std::optional<QRectF> drawn = shown();
  cancel();
  return drawn;
}

}  // namespace laparoscope_servo::screen
