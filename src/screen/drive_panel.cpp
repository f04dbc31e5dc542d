#include "screen/drive_panel.h"

#include <QVBoxLayout>

#include "screen/push_button.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kTaskHeight = 32;  // px

}  // namespace

DrivePanel::DrivePanel(RosLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(2, 2, 2, 2);
  layout->setSpacing(2);
  auto* tasks = new QHBoxLayout;
  follow_ = makeButton(
      "Follow", "The scope keeps the region where it was", [this] { link_.selectTask("HOLD_VIEW"); }, this);
  drive_ = makeButton(
      "Drive by hand", "The scope follows the sliders", [this] { link_.selectTask("MANUAL"); }, this);
  for (QPushButton* button : {follow_, drive_}) {
    button->setFixedHeight(kTaskHeight);
    tasks->addWidget(button);
  }
  layout->addLayout(tasks);
  const char* const names[4][3] = {
      {"Pan", "left", "right"}, {"Tilt", "down", "up"}, {"Spin", "left", "right"}, {"Insertion", "out", "deeper"}};
  for (std::size_t k = 0; k < sliders_.size(); ++k) {
    sliders_[k] = new VelocitySlider(
        names[k][0], names[k][1], names[k][2], link_.slider(), [this] { passShares(); }, [this] { link_.said(); },
        this);
    layout->addWidget(sliders_[k]);
  }
  layout->addStretch(1);
}

void DrivePanel::passShares() {
  std::array<double, 4> values{};
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = sliders_[k] != nullptr ? sliders_[k]->share() : 0.0;
  link_.setShares(values);
  link_.said();
}

void DrivePanel::show(const Facts& facts) {
  const std::string task = facts.controller.connected ? facts.controller.task : "";
  markActive(*follow_, task == "HOLD_VIEW");
  markActive(*drive_, task == "MANUAL");
  const bool by_hand = task == "MANUAL" && facts.limits.has_value();
  for (std::size_t k = 0; k < sliders_.size(); ++k) {
    sliders_[k]->setEnabled(by_hand);
    if (!facts.limits) continue;
    const double limit = (*facts.limits)[k];
    sliders_[k]->setLimit(k < 3 ? QString::number(limit, 'g', 3) + " rad/s"
                                : QString::number(1e3 * limit, 'g', 3) + " mm/s");
  }
}

void DrivePanel::beat() {
  for (VelocitySlider* slider : sliders_) slider->beat();
}

void DrivePanel::letGo() {
  for (VelocitySlider* slider : sliders_) slider->letGo();
}

}  // namespace laparoscope_servo::screen
