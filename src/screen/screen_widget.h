// The screen: picture, three bands, what one may do. The same in a window of its own and as rviz panel.
//
// It holds no state that the nodes lack, waits for nobody, and stops by Escape or Pause from any focus within its
// program.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QWidget>
#include <array>
#include <functional>
#include <memory>

#include "screen/dead_man_button.h"
#include "screen/image_view.h"
#include "screen/ros_link.h"
#include "screen/state_band.h"
#include "screen/velocity_slider.h"

namespace laparoscope_servo::screen {

class ScreenWidget : public QWidget {
  Q_OBJECT
 public:
  // After ros::init.
  explicit ScreenWidget(QWidget* parent = nullptr);
  ~ScreenWidget() override;

  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  void refresh();
  void beat();
  void stop();
  bool hasFocusWithin() const;
  bool handleKey(int key, bool pressed);
  QWidget* makeActions();
  QWidget* makeColumn();
  QPushButton* makeButton(const QString& text, const QString& tip, const std::function<void()>& act);
  void showAnswer(const Answer& answer);
  void showTask(const Facts& facts);

  std::unique_ptr<RosLink> link_;
  ImageView* image_;
  StateBand* tracker_;
  StateBand* controller_;
  StateBand* robot_;
  QLabel* answer_;
  QPushButton* follow_;
  QPushButton* drive_;
  DeadManButton* dead_man_;
  std::array<VelocitySlider*, 4> sliders_{};
  QTimer beat_timer_;
};

}  // namespace laparoscope_servo::screen
