#include "screen/dead_man_button.h"

#include <QPainter>
#include <QTimer>
#include <cmath>

#include "ros/common/clocks.h"

namespace laparoscope_servo::screen {

DeadManButton::DeadManButton(HeldControl& control, const std::function<void()>& changed, QWidget* parent)
    : HoldArea(control, changed, parent) {
  setObjectName("dead_man");
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setMinimumHeight(48);
}

void DeadManButton::setWanted(bool wanted) {
  if (wanted == wanted_) return;
  wanted_ = wanted;
  if (!wanted) letGo();
  update();
}

QString DeadManButton::obstacle() const {
  return wanted_ ? HoldArea::obstacle() : "nobody listens";
}

// A key that stays down after the hold has ended does not start a new one, since key_ still counts it as held.
void DeadManButton::keyPressed() {
  if (key_.press()) take(By::kKey);
}

void DeadManButton::keyReleased() {
  key_.release(steadyNow());
  // A millisecond more than the gap, since the timer may be early by one.
  QTimer::singleShot(static_cast<int>(std::ceil(1e3 * kRepeatGap)) + 1, Qt::PreciseTimer, this, [this] {
    if (key_.released(steadyNow())) letGo();
  });
}

void DeadManButton::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF box = QRectF(rect()).adjusted(1.5, 1.5, -1.5, -1.5);
  painter.setPen(QPen(wanted_ ? Qt::white : QColor(0x60, 0x66, 0x70), isHeld() ? 4 : 2));
  painter.setBrush(isHeld() ? QColor(0x1f, 0x7a, 0x40) : QColor(0x2a, 0x2f, 0x38));
  painter.drawRoundedRect(box, 6, 6);
  QFont font = this->font();
  font.setPixelSize(17);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(wanted_ ? Qt::white : QColor(0x90, 0x96, 0xa0));
  const QString text = !wanted_   ? "No dead-man switch is asked for"
                       : isHeld() ? "HELD: the scope may move"
                                  : "HOLD to let it move   (key F9)";
  painter.drawText(rect(), Qt::AlignCenter, text);
}

}  // namespace laparoscope_servo::screen
