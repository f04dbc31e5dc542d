// The screen: picture, three bands, and controls. Used both in its own window and as rviz panel.
//
// It has no state of its own beside that of the nodes, never blocks, and stops the arm on Escape or Pause, wherever the
// focus is within its program.
#pragma once

#include <QTabWidget>
#include <QTimer>
#include <QWidget>
#include <memory>

#include "screen/dead_man_button.h"
#include "screen/drive_panel.h"
#include "screen/features/features_panel.h"
#include "screen/fitted_label.h"
#include "screen/image_view.h"
#include "screen/minute_panel.h"
#include "screen/parameter_panel.h"
#include "screen/playback_bar.h"
#include "screen/recording_bar.h"
#include "screen/ros_link.h"
#include "screen/state_band.h"
#include "screen/views_panel.h"

namespace laparoscope_servo::screen {

class ScreenWidget : public QWidget {
  Q_OBJECT
 public:
  // Construct it after ros::init. `space`: the namespace of the cart, seen from that of the process; empty: the same.
  explicit ScreenWidget(QWidget* parent = nullptr, const std::string& space = "");
  ~ScreenWidget() override;

  bool eventFilter(QObject* object, QEvent* event) override;
  // What the button STOP does.
  void stop();

 private:
  void refresh();
  void beat();
  // Ends what is held.
  void letGo();
  bool hasFocusWithin() const;
  bool handleKey(int key, bool pressed);
  void select(const QRect& pixels);
  void playPaused(std::int64_t stamp);
  QWidget* makeColumn(const std::string& space);
  QWidget* makeTabs();
  void showAnswer(const Answer& answer);
  void showMinute(const Facts& facts, double now);

  std::unique_ptr<RosLink> link_;
  ImageView* image_;
  RecordingBar* recording_;
  PlaybackBar* playback_;
  StateBand* tracker_;
  StateBand* controller_;
  StateBand* robot_;
  FittedLabel* answer_;
  ViewsPanel* views_;
  FeaturesPanel* features_;
  MinutePanel* minute_;
  ParameterPanel* parameters_;
  double minute_shown_at_ = kNever;
  DrivePanel* drive_;
  DeadManButton* dead_man_;
  QTimer beat_timer_;
};

}  // namespace laparoscope_servo::screen
