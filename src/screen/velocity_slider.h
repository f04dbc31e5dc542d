// One velocity of the scope, in MANUAL. Zero is in the middle. Only dragging with the mouse button held moves it,
// relative to the place of the press; on release it returns to zero. Wheel, keys and focus have no effect.
#pragma once

#include <QString>
#include <functional>

#include "screen/hold_area.h"

namespace laparoscope_servo::screen {

class VelocitySlider : public HoldArea {
  Q_OBJECT
 public:
  // `share_changed` is called before `changed`.
  VelocitySlider(const QString& name, const QString& less, const QString& more, HeldControl& control,
                 const std::function<void()>& share_changed, const std::function<void()>& changed, QWidget* parent);

  double share() const { return share_; }  // -1 to 1 of the limit
  // Shown beside it, e.g. "0.10 rad/s".
  void setLimit(const QString& limit);
  QSize sizeHint() const override { return {260, 34}; }

 private:
  void paintEvent(QPaintEvent* event) override;
  void taken(const QPoint& at) override;
  void moved(const QPoint& at) override;
  void ended() override;
  QRect track() const;

  QString name_, less_, more_, limit_;
  std::function<void()> share_changed_;
  double share_ = 0.0;
  int taken_at_ = 0;  // px
};

}  // namespace laparoscope_servo::screen
