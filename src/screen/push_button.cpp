#include "screen/push_button.h"

#include <QStyle>
#include <QVariant>

namespace laparoscope_servo::screen {

namespace {

// Of the button itself, since the one of a small display (SmallWindow) stands outside of the screen's own style. That
// one fills the width, and has nothing beside it to be told from.
const char* const kStopStyle = R"(
  QPushButton { background: #c01818; color: white; border: 3px solid white; border-radius: 5px; font-size: 40px;
                font-weight: bold; }
  QPushButton:hover { background: #d02020; }
  QPushButton:pressed { background: #ff3030; }
  QPushButton#stop_in_sight { border: 0; }
)";

}  // namespace

QPushButton* makeButton(const QString& text, const QString& tip, const std::function<void()>& act, QWidget* parent) {
  auto* button = new QPushButton(text, parent);
  button->setObjectName(text.toLower().replace(' ', '_'));
  button->setToolTip(tip);
  button->setFocusPolicy(Qt::NoFocus);
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  QObject::connect(button, &QPushButton::clicked, button, [act] { act(); });
  return button;
}

QPushButton* makeStopButton(const std::function<void()>& act, QWidget* parent) {
  QPushButton* button = makeButton(
      "STOP", "Disengages and disables: also by Escape or Pause", [] {}, parent);
  button->setStyleSheet(kStopStyle);
  QObject::connect(button, &QPushButton::pressed, button, [act] { act(); });
  return button;
}

void markActive(QPushButton& button, bool active) {
  if (button.property("active").toBool() == active) return;
  button.setProperty("active", active);
  button.style()->unpolish(&button);
  button.style()->polish(&button);
}

}  // namespace laparoscope_servo::screen
