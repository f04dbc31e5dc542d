// Slows rviz's 3D view where the processor draws it: at 15 Hz that takes half of what the tracker needs. While somebody
// turns the view it is faster. One for each rviz.
#pragma once

#include <rviz/visualization_manager.h>

#include <QTimer>

namespace laparoscope_servo::screen {

// By the name that the driver gives its renderer.
bool drawnByProcessor(const std::string& renderer);

class FrameRate : public QObject {
  Q_OBJECT
 public:
  // Does nothing where a graphics card draws, or where the manager has one already.
  static void guard(rviz::VisualizationManager& manager);

 private:
  FrameRate(rviz::VisualizationManager& manager, rviz::Property& rate);
  bool eventFilter(QObject* object, QEvent* event) override;
  void set(int rate);

  rviz::Property& rate_;
  int resting_;
  int last_;  // what was set here; another value is somebody's wish
  QTimer rest_;
};

}  // namespace laparoscope_servo::screen
