#include "screen/panel.h"

#include <ros/names.h>
#include <rviz/config.h>

#include <QLabel>
#include <pluginlib/class_list_macros.hpp>

#include "screen/space/frame_rate.h"

namespace laparoscope_servo::screen {

Panel::Panel(QWidget* parent) : rviz::Panel(parent) {
  layout_ = new QVBoxLayout(this);
  layout_->setContentsMargins(0, 0, 0, 0);
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel("Namespace of the cart", this));
  row->addWidget(space_ = new QLineEdit(this));
  space_->setObjectName("space");
  space_->setPlaceholderText("that of rviz");
  space_->setFocusPolicy(Qt::ClickFocus);
  layout_->addLayout(row);
  connect(space_, &QLineEdit::editingFinished, this, [this] {
    if (screen_ && screen_->property("space").toString() == space_->text()) return;
    follow(space_->text());
    Q_EMIT configChanged();
  });
  follow("");
}

void Panel::onInitialize() {
  FrameRate::guard(*vis_manager_);
}

// Ignores a text that is no valid name.
void Panel::follow(const QString& space) {
  std::string error;
  if (!space.isEmpty() && !ros::names::validate(space.toStdString(), error)) {
    space_->setText(screen_ ? screen_->property("space").toString() : QString());
    space_->setToolTip(QString::fromStdString(error).toHtmlEscaped());
    return;
  }
  screen_.reset();
  screen_ = std::make_unique<ScreenWidget>(this, space.toStdString());
  screen_->setProperty("space", space);
  layout_->addWidget(screen_.get(), 1);
}

void Panel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString space;
  if (!config.mapGetString("Namespace", &space) || space.isEmpty()) return;
  space_->setText(space);
  follow(space);
}

void Panel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Namespace", space_->text());
}

}  // namespace laparoscope_servo::screen

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::screen::Panel, rviz::Panel)
