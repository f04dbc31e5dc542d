#include "screen/small_window.h"

#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "screen/push_button.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kStopHeight = 56;  // px

}  // namespace

SmallWindow::SmallWindow(ScreenWidget* screen) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  auto* area = new QScrollArea(this);
  area->setFrameShape(QFrame::NoFrame);
  area->setFocusPolicy(Qt::NoFocus);
  area->setWidgetResizable(true);
  area->setWidget(screen);
  layout->addWidget(area, 1);
  auto* stop = makeButton(
      "STOP", "Disengages and disables: also by Escape or Pause", [] {}, this);
  stop->setObjectName("stop_in_sight");
  stop->setStyleSheet("background: #c01818; color: white; font-size: 34px; font-weight: bold;");
  stop->setFixedHeight(kStopHeight);
  connect(stop, &QPushButton::pressed, screen, &ScreenWidget::stop);
  layout->addWidget(stop);
}

}  // namespace laparoscope_servo::screen
