// A widget that a hand holds: it is taken by the left mouse button, and by nothing else than what a subclass adds.
//
// The hold ends with the button, and with everything that could swallow its release: the window loses the focus, is
// minimised or hidden, a popup or a dialog opens, the widget is disabled. Another press is needed then. beat() looks
// for all of it, too, for an event may be lost; who does not call it ends the hold as well (HeldControl).
#pragma once

#include <QWidget>
#include <functional>

#include "screen/held_control.h"

namespace laparoscope_servo::screen {

class HoldArea : public QWidget {
  Q_OBJECT
 public:
  // `changed` is called when the hold begins or ends. `control` outlives the widget.
  HoldArea(HeldControl& control, const std::function<void()>& changed, QWidget* parent);

  // 20 times a second, by the GUI's thread.
  void beat();
  void letGo();
  bool isHeld() const { return by_ != By::kNobody; }

 protected:
  enum class By { kNobody, kMouse, kKey };
  bool take(By by);
  // At (x, y) the mouse took it, was moved, let go.
  virtual void taken(const QPoint&) {}
  virtual void moved(const QPoint&) {}
  virtual void ended() {}
  // Why it cannot be held now; empty: it can.
  virtual QString obstacle() const;

  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override { mousePressEvent(event); }
  void wheelEvent(QWheelEvent* event) override;
  bool event(QEvent* event) override;

 private:
  HeldControl& control_;
  std::function<void()> changed_;
  By by_ = By::kNobody;
};

}  // namespace laparoscope_servo::screen
