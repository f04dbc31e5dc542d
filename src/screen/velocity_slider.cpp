#include "screen/velocity_slider.h"

#include <QPainter>
#include <algorithm>

namespace laparoscope_servo::screen {

namespace {

constexpr int kNameWidth = 84;    // px
constexpr int kLeastHeight = 22;  // px, on a display of 768 px

}  // namespace

VelocitySlider::VelocitySlider(const QString& name, const QString& less, const QString& more, HeldControl& control,
                               const std::function<void()>& share_changed, const std::function<void()>& changed,
                               QWidget* parent)
    : HoldArea(control, changed, parent), name_(name), less_(less), more_(more), share_changed_(share_changed) {
  setObjectName(name);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  setMinimumHeight(kLeastHeight);
  setMaximumHeight(sizeHint().height());
}

void VelocitySlider::setLimit(const QString& limit) {
  if (limit == limit_) return;
  limit_ = limit;
  update();
}

QRect VelocitySlider::track() const {
  return rect().adjusted(kNameWidth, 4, -6, -4);
}

void VelocitySlider::taken(const QPoint& at) {
  taken_at_ = at.x();
  share_ = 0.0;
  share_changed_();
}

void VelocitySlider::moved(const QPoint& at) {
  const double half = std::max(20.0, 0.5 * track().width());
  share_ = std::clamp((at.x() - taken_at_) / half, -1.0, 1.0);
  share_changed_();
  update();
}

void VelocitySlider::ended() {
  share_ = 0.0;
  share_changed_();
}

void VelocitySlider::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor ink = isEnabled() ? QColor(Qt::white) : QColor(0x78, 0x7e, 0x88);
  QFont font = this->font();
  font.setPixelSize(14);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(ink);
  painter.drawText(QRect(2, 0, kNameWidth - 4, height()), Qt::AlignLeft | Qt::AlignVCenter, name_);

  const QRect track = this->track();
  painter.setPen(QPen(ink, 1));
  painter.setBrush(QColor(0x2a, 0x2f, 0x38));
  painter.drawRoundedRect(track, 4, 4);
  const int middle = track.center().x();
  painter.drawLine(middle, track.top(), middle, track.bottom());
  font.setPixelSize(11);
  font.setBold(false);
  painter.setFont(font);
  painter.drawText(track.adjusted(6, 0, -6, 0), Qt::AlignLeft | Qt::AlignVCenter, "◀ " + less_);
  painter.drawText(track.adjusted(6, 0, -6, 0), Qt::AlignRight | Qt::AlignVCenter, more_ + " ▶");

  const double half = 0.5 * track.width() - 8.0;
  const QPointF handle(middle + share_ * half, track.center().y() + 0.5);
  painter.setPen(QPen(Qt::black, 1));
  painter.setBrush(!isEnabled() ? QColor(0x60, 0x66, 0x70) : isHeld() ? QColor(0x2e, 0xb8, 0x5c) : QColor(Qt::white));
  painter.drawRoundedRect(QRectF(handle.x() - 7, track.top() + 1, 14, track.height() - 2), 3, 3);
  if (!isHeld() || limit_.isEmpty()) return;
  painter.setPen(ink);
  const Qt::Alignment side = share_ > 0.0 ? Qt::AlignLeft : Qt::AlignRight;
  painter.fillRect(side == Qt::AlignLeft ? QRect(track.left() + 70, track.top() + 2, 90, track.height() - 4)
                                         : QRect(track.right() - 160, track.top() + 2, 90, track.height() - 4),
                   QColor(0x2a, 0x2f, 0x38));
  painter.drawText(track.adjusted(72, 0, -72, 0), side | Qt::AlignVCenter,
                   QString::number(100.0 * share_, 'f', 0) + " % of " + limit_);
}

}  // namespace laparoscope_servo::screen
