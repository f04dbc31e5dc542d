#include "screen/push_button.h"

#include <QStyle>
#include <QVariant>

namespace laparoscope_servo::screen {

QPushButton* makeButton(const QString& text, const QString& tip, const std::function<void()>& act, QWidget* parent) {
  auto* button = new QPushButton(text, parent);
  button->setObjectName(text.toLower().replace(' ', '_'));
  button->setToolTip(tip);
  button->setFocusPolicy(Qt::NoFocus);
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  QObject::connect(button, &QPushButton::clicked, button, [act] { act(); });
  return button;
}

void markActive(QPushButton& button, bool active) {
  if (button.property("active").toBool() == active) return;
  button.setProperty("active", active);
  button.style()->unpolish(&button);
  button.style()->polish(&button);
}

}  // namespace laparoscope_servo::screen
