// Draws, moves and resizes a region by one drag of the mouse. Points are in the widget's pixels.
#pragma once

#include <QPointF>
#include <QRectF>
#include <optional>

namespace laparoscope_servo::screen {

class RegionDrag {
 public:
  enum class Kind { kNone, kDraw, kMove, kResize };

  // `present`: bounding box of the present region. A press near a corner resizes it, inside moves it, and anywhere
  // else, or with `anew`, draws a new one. All stays inside `bounds`.
  void press(const QPointF& at, const std::optional<QRectF>& present, const QRectF& bounds, bool anew);
  void move(const QPointF& at);
  // The drawn region; empty for a click, or without a press.
  std::optional<QRectF> release(const QPointF& at);
  void cancel() { kind_ = Kind::kNone; }

  Kind kind() const { return kind_; }
  bool isActive() const { return kind_ != Kind::kNone; }
  // The region to show while drawing; empty while it may still be a click.
  std::optional<QRectF> shown() const;
  // The effect of a press at this place.
  static Kind kindAt(const QPointF& at, const std::optional<QRectF>& present, bool anew);

 private:
  Kind kind_ = Kind::kNone;
  QRectF bounds_;
  QRectF start_;    // when moved: the region at the start
  QPointF anchor_;  // when drawn or resized: the fixed corner; when moved: the grabbed point
  QPointF press_;
  QPointF at_;
  bool far_enough_ = false;
};

}  // namespace laparoscope_servo::screen
