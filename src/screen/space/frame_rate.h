// Slows rviz's 3D view where the processor draws it: at 15 Hz that takes half of what the tracker needs. While somebody
// turns the view it is faster. One for each rviz, as long as one of its users lives: rviz unloads the library of the
// panels before it deletes the view, whose events come here.
#pragma once

#include <rviz/visualization_manager.h>

#include <QTimer>

namespace laparoscope_servo::screen {

// By the name that the driver gives its renderer.
bool drawnByProcessor(const std::string& renderer);

class FrameRate : public QObject {
  Q_OBJECT
 public:
  // Does nothing where a graphics card draws.
  static void guard(rviz::VisualizationManager& manager, const QObject& user);

 private:
  FrameRate(rviz::VisualizationManager& manager, rviz::Property& rate);
  bool eventFilter(QObject* object, QEvent* event) override;
  void set(int rate);

  rviz::Property& rate_;
  int resting_;
  int last_;  // what was set here; another value is somebody's wish
  QTimer rest_;
  int users_ = 0;
};

}  // namespace laparoscope_servo::screen
