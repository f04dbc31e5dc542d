#include "screen/panel.h"

#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "screen/screen_widget.h"

namespace laparoscope_servo::screen {

Panel::Panel(QWidget* parent) : rviz::Panel(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(new ScreenWidget(this));
}

}  // namespace laparoscope_servo::screen

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::screen::Panel, rviz::Panel)
