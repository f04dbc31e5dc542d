// A widget that is held by the left mouse button, and by what a subclass adds.
//
// The hold ends when the button is released, and on every event that could hide a release: the window loses the focus,
// is minimised or hidden, a popup or a dialog opens, the widget is disabled. Another press is then needed. beat() also
// checks for all of these, since an event may be lost; the hold also ends if beat() is not called (HeldControl).
#pragma once

#include <QWidget>
#include <functional>

#include "screen/held_control.h"

namespace laparoscope_servo::screen {

class HoldArea : public QWidget {
  Q_OBJECT
 public:
  // `changed` is called when the hold begins or ends. `control` must outlive the widget.
  HoldArea(HeldControl& control, const std::function<void()>& changed, QWidget* parent);

  // Call 20 times a second in the GUI's thread.
  void beat();
  void letGo();
  bool isHeld() const { return by_ != By::kNobody; }

 protected:
  enum class By { kNobody, kMouse, kKey };
  bool take(By by);
  // Called when the mouse pressed, moved and released at (x, y).
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
