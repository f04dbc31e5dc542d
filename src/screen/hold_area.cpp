#include "screen/hold_area.h"

#include <QApplication>
#include <QMouseEvent>
#include <QWheelEvent>

#include "ros/common/clocks.h"

namespace laparoscope_servo::screen {

HoldArea::HoldArea(HeldControl& control, const std::function<void()>& changed, QWidget* parent)
    : QWidget(parent), control_(control), changed_(changed) {
  setFocusPolicy(Qt::NoFocus);
  setContextMenuPolicy(Qt::PreventContextMenu);
  connect(qApp, &QGuiApplication::applicationStateChanged, this, [this](Qt::ApplicationState state) {
    if (state != Qt::ApplicationActive) letGo();
  });
}

QString HoldArea::obstacle() const {
  if (!isEnabled() || !isVisible()) return "not shown";
  if (window()->isMinimized()) return "the window is minimised";
  if (!isActiveWindow()) return "the window has no focus: click into it first";
  if (QApplication::activePopupWidget() != nullptr || QApplication::activeModalWidget() != nullptr)
    return "a menu or a dialog is open";
  return {};
}

bool HoldArea::take(By by) {
  if (isHeld()) return by_ == by;
  if (!obstacle().isEmpty()) return false;
  by_ = by;
  control_.take(steadyNow());
  changed_();
  update();
  return true;
}

void HoldArea::letGo() {
  if (!isHeld()) return;
  by_ = By::kNobody;
  control_.letGo();
  ended();
  changed_();
  update();
}

void HoldArea::beat() {
  const bool let_go = by_ == By::kMouse && !(QGuiApplication::mouseButtons() & Qt::LeftButton);
  if (isHeld() && (let_go || !obstacle().isEmpty())) letGo();
  if (!isHeld()) return;
  const double now = steadyNow();
  control_.beat(now);
  // The GUI was silent for too long, and the sending thread has ended the hold.
  if (!control_.isHeld(now)) letGo();
}

void HoldArea::mousePressEvent(QMouseEvent* event) {
  event->accept();
  if (event->button() != Qt::LeftButton) return letGo();
  if (isHeld()) return;
  if (!isActiveWindow()) window()->activateWindow();
  if (take(By::kMouse)) taken(event->pos());
}

void HoldArea::mouseMoveEvent(QMouseEvent* event) {
  event->accept();
  if (by_ != By::kMouse) return;
  if (event->buttons() & Qt::LeftButton) return moved(event->pos());
  letGo();
}

void HoldArea::mouseReleaseEvent(QMouseEvent* event) {
  event->accept();
  if (event->button() == Qt::LeftButton && by_ == By::kMouse) letGo();
}

// The wheel has no effect here, nor on widgets below.
void HoldArea::wheelEvent(QWheelEvent* event) {
  event->accept();
}

bool HoldArea::event(QEvent* event) {
  switch (event->type()) {
    case QEvent::Hide:
    case QEvent::WindowDeactivate:
    case QEvent::WindowBlocked:
    case QEvent::EnabledChange:
    case QEvent::ParentChange:
    case QEvent::UngrabMouse:
      letGo();
      break;
    default:
      break;
  }
  return QWidget::event(event);
}

}  // namespace laparoscope_servo::screen
