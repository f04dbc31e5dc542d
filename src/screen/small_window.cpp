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
  QPushButton* stop = makeStopButton([screen] { screen->stop(); }, this);
  stop->setObjectName("stop_in_sight");
  stop->setFixedHeight(kStopHeight);
  layout->addWidget(stop);
}

}  // namespace laparoscope_servo::screen
