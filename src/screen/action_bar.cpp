#include "screen/action_bar.h"

#include <QGridLayout>

#include "screen/push_button.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kHeight = 96;      // px
constexpr int kStopWidth = 136;  // px

}  // namespace

ActionBar::ActionBar(RosLink& link, const std::function<void()>& stop, QWidget* parent) : QWidget(parent) {
  setFixedHeight(kHeight);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(6);
  const auto add = [&](int row, int column, const char* text, const char* tip, const std::function<void()>& act) {
    grid->addWidget(makeButton(text, tip, act, this), row, column);
  };
  add(0, 0, "Enable", "The arm may move when it is told to", [&link] { link.enable(); });
  add(1, 0, "Disable", "The arm stands, and may be moved by hand", [&link] { link.disable(); });
  add(0, 1, "Engage", "The controller moves the scope", [&link] { link.engage(true); });
  add(1, 1, "Disengage", "The controller stands", [&link] { link.engage(false); });
  add(0, 2, "Hold", "The arm pauses", [&link] { link.pause(); });
  add(1, 2, "Resume", "A paused arm goes on", [&link] { link.resume(); });
  add(0, 3, "Clear region", "The tracker forgets its region", [&link] { link.tracker().clearRegion(); });
  add(1, 3, "Clear fault", "After its cause was removed", [&link] { link.clearFault(); });
  add(0, 4, "Freeze", "Keeps this picture, to draw a region in it at leisure; the arm is not held by it",
      [&link] { link.tracker().freeze(); });
  add(1, 4, "Live", "Back from the frozen picture", [&link] { link.tracker().thaw(); });
  QPushButton* stop_button = makeStopButton(stop, this);
  stop_button->setMinimumWidth(kStopWidth);
  grid->addWidget(stop_button, 0, 5, 2, 1);
  for (int column = 0; column < 5; ++column) grid->setColumnStretch(column, 2);
  grid->setColumnStretch(5, 3);
}

}  // namespace laparoscope_servo::screen
