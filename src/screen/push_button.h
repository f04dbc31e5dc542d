// The screen's buttons.
#pragma once

#include <QPushButton>
#include <QString>
#include <functional>

namespace laparoscope_servo::screen {

// Its object name is the text in lower case, with _ for each space. It never takes the focus, since the space bar would
// press it then.
QPushButton* makeButton(const QString& text, const QString& tip, const std::function<void()>& act, QWidget* parent);

// Acts when it is pressed, not when it is released.
QPushButton* makeStopButton(const std::function<void()>& act, QWidget* parent);

// Marks the active one of several buttons.
void markActive(QPushButton& button, bool active);

}  // namespace laparoscope_servo::screen
