#include "screen/drive_panel.h"

#include <QEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <QVariant>

#include "screen/band_text.h"
#include "screen/push_button.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kTasksInARow = 4;    // as many as their names have room for
constexpr int kTaskHeight = 20;    // px: two rows, on a display of 768 px
constexpr int kLeastPromise = 42;  // px: three lines of the smallest font, on a display of 768 px
constexpr int kMostPromise = 50;   // px: three lines of the largest one
constexpr int kKeepWidth = 118;    // px

}  // namespace

DrivePanel::DrivePanel(RosLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(2, 2, 2, 2);
  layout->setSpacing(2);
  auto* tasks = new QGridLayout;
  tasks->setHorizontalSpacing(4);
  tasks->setVerticalSpacing(2);
  for (const TaskWords& words : taskWords()) {
    // Without a tool tip, which would hide the line below that says more.
    QPushButton* button = makeButton(
        QString::fromStdString(words.name), "", [this, task = words.task] { link_.selectTask(task); }, this);
    button->setProperty("task", true);
    button->setFixedHeight(kTaskHeight);
    button->installEventFilter(this);
    const int place = static_cast<int>(tasks_.size());
    tasks->addWidget(button, place / kTasksInARow, place % kTasksInARow);
    tasks_.push_back(button);
  }
  layout->addLayout(tasks);
  auto* row = new QHBoxLayout;
  row->setSpacing(4);
  row->addWidget(promise_ = new FittedLabel("promise", kLeastPromise, kMostPromise, this), 1);
  keep_view_ = makeButton(
      "Keep this view", "What is seen now is what the task Stabilise keeps", [this] { link_.keepView(); }, this);
  keep_view_->setProperty("task", true);
  keep_view_->setFixedWidth(kKeepWidth);
  keep_view_->setVisible(false);
  row->addWidget(keep_view_);
  layout->addLayout(row);
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

// A task is explained before its button is pressed.
bool DrivePanel::eventFilter(QObject* object, QEvent* event) {
  if (event->type() != QEvent::Enter && event->type() != QEvent::Leave) return QWidget::eventFilter(object, event);
  pointed_at_ = nullptr;
  for (std::size_t k = 0; k < tasks_.size() && event->type() == QEvent::Enter; ++k) {
    if (tasks_[k] == object) pointed_at_ = &taskWords()[k];
  }
  tellTask();
  return QWidget::eventFilter(object, event);
}

void DrivePanel::tellTask() {
  const std::string& current = controller_.task;
  const TaskWords* words = pointed_at_ != nullptr ? pointed_at_ : wordsOfTask(current);
  if (words != nullptr) {
    const bool moves = controller_.state == "SERVO";
    return promise_->say(QString::fromStdString(promise(*words, current, controller_.engaged, moves)));
  }
  promise_->say(current.empty() ? "No controller says which task it has."
                                : QString::fromStdString("This screen does not know the task " + current + "."));
}

void DrivePanel::passShares() {
  std::array<double, 4> values{};
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = sliders_[k] != nullptr ? sliders_[k]->share() : 0.0;
  link_.setShares(values);
  link_.said();
}

void DrivePanel::show(const Facts& facts, double now) {
  controller_ = controllerSpeaks(facts, now) ? facts.controller : ControllerFacts();
  const std::string& task = controller_.task;
  for (std::size_t k = 0; k < tasks_.size(); ++k) markActive(*tasks_[k], task == taskWords()[k].task);
  keep_view_->setVisible(task == "STABILISE" || task == "PARALLEL");
  tellTask();
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
