#include "screen/panel.h"

#include <ros/names.h>
#include <rviz/config.h>

#include <QDockWidget>
#include <QGuiApplication>
#include <QLabel>
#include <QMainWindow>
#include <QScreen>
#include <pluginlib/class_list_macros.hpp>

#include "screen/space/frame_rate.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kViewWidth = 100;  // px, what is left at least for the view in space, and for frames

}  // namespace

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
  FrameRate::guard(*vis_manager_, *this);
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

// rviz would put it below another screen, where 1000 px of height have no room for its STOP: it comes beside that one,
// or where the display is too narrow for both, behind it, with a tab for each. Where the configuration has an
// arrangement of its own, rviz restores that later.
void Panel::standBesideOthers() {
  auto* frame = qobject_cast<QMainWindow*>(window());
  auto* dock = qobject_cast<QDockWidget*>(parentWidget());
  if (frame == nullptr || dock == nullptr) return;
  const int room = QGuiApplication::primaryScreen()->availableSize().width() - kViewWidth;
  for (QDockWidget* other : frame->findChildren<QDockWidget*>()) {
    if (other == dock || qobject_cast<Panel*>(other->widget()) == nullptr) continue;
    if (other->minimumSizeHint().width() + dock->minimumSizeHint().width() <= room) {
      frame->splitDockWidget(other, dock, Qt::Horizontal);
    } else {
      frame->tabifyDockWidget(other, dock);
    }
  }
}

void Panel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  standBesideOthers();
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
