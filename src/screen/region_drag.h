// Draws, moves and resizes a region by one drag of the mouse. Points are in the widget's pixels.
#pragma once

#include <QPointF>
#include <QRectF>
#include <optional>

namespace laparoscope_servo::screen {

class RegionDrag {
 public:
  enum class Kind { kNone, kDraw, kMove, kResize };

  // `present`: the region that there is, about its corners. Near one of them it is resized, inside it is moved, and
  // anywhere else, or with `anew`, another one is drawn. All stays inside `bounds`.
  void press(const QPointF& at, const std::optional<QRectF>& present, const QRectF& bounds, bool anew);
  void move(const QPointF& at);
  // The region that was drawn; empty for a click, or when nothing was begun.
  std::optional<QRectF> release(const QPointF& at);
  void cancel() { kind_ = Kind::kNone; }

  Kind kind() const { return kind_; }
  bool isActive() const { return kind_ != Kind::kNone; }
  // To be shown while it is drawn; empty while it may still be a click.
  std::optional<QRectF> shown() const;
  // What a press at this place would do.
  static Kind kindAt(const QPointF& at, const std::optional<QRectF>& present, bool anew);

 private:
  Kind kind_ = Kind::kNone;
  QRectF bounds_;
  QRectF start_;    // moved: the region before
  QPointF anchor_;  // drawn, resized: the corner that stays; moved: where it was taken
  QPointF press_;
  QPointF at_;
  bool far_enough_ = false;
};

}  // namespace laparoscope_servo::screen
