// The screen in a window of this process, on a display of its own: events are the X server's, and the test knows where
// the widgets are.
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <QApplication>
#include <QPushButton>
#include <QWindow>
#include <functional>
#include <memory>

#include "ros/common/clocks.h"
#include "screen/screen_widget.h"
#include "support/ros_tests.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo::test_support {

// Lets the GUI live meanwhile.
inline bool waitFor(const std::function<bool()>& condition, double seconds = 30.0) {
  const double until = steadyNow() + seconds;
  while (!condition()) {
    if (steadyNow() > until || !ros::ok()) return false;
    QApplication::processEvents(QEventLoop::AllEvents, 10);
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

class ScreenFixture : public testing::Test {
 protected:
  void show(const QSize& size) {
    if (!screen_) screen_ = std::make_unique<screen::ScreenWidget>();
    screen_->move(0, 0);
    screen_->resize(size);
    screen_->show();
    ASSERT_TRUE(waitFor([this] { return screen_->isVisible() && screen_->windowHandle()->isExposed(); }));
    focus(*screen_);
  }
  // As a window manager does at a click.
  void focus(QWidget& window) {
    ASSERT_TRUE(waitFor([&] {
      hands("windowfocus " + std::to_string(window.winId()) + " 2>/dev/null || true");
      return waitFor([&] { return window.isActiveWindow(); }, 1.0);
    }));
  }
  QPoint centreOf(const QWidget& widget) const { return widget.mapToGlobal(widget.rect().center()); }
  template <class Widget>
  Widget& find(const QString& name) const {
    auto* widget = screen_->findChild<Widget*>(name);
    if (widget == nullptr) throw std::runtime_error("no widget " + name.toStdString());
    return *widget;
  }
  std::string word(const QString& band) const { return find<screen::StateBand>(band).text().word; }
  void click(const QString& button) { hands(moveTo(centreOf(find<QPushButton>(button))) + "click 1"); }
  screen::ImageView& image() const { return find<screen::ImageView>("image"); }
  // Where a point of the original image, in px of edges, is on the display.
  QPoint onDisplay(const QSize& original, const QPointF& edge) const {
    const screen::Letterbox box(original, QRectF(image().rect()));
    return image().mapToGlobal(box.fromEdge(edge).toPoint());
  }
  double pixelOfDisplay(const QSize& original) const {  // px of the image
    return 1.0 / screen::Letterbox(original, QRectF(image().rect())).scale();
  }
  void drag(const QPoint& from, const QPoint& to) {
    hands(moveTo(from) + "mousedown 1 " + moveTo((from + to) / 2) + moveTo(to) + "mouseup 1");
  }
  // Draws until the tracker tracks: a busy machine makes the picture old for a moment, and then nothing can be drawn.
  bool selects(const QPoint& from, const QPoint& to) {
    for (int tries = 0; tries < 10; ++tries) {
      drag(from, to);
      if (waitFor([this] { return word("Tracker") == "TRACKING"; }, 5.0)) return true;
    }
    return false;
  }
  // The middle of the picture has a colour.
  bool isColoured() const {
    const QImage shown = image().grab().toImage();
    return shown.pixelColor(shown.width() / 2, shown.height() / 3).hsvSaturation() > 60;
  }

  std::unique_ptr<screen::ScreenWidget> screen_;
};

// The body of main().
inline int runScreenTests(int argc, char** argv, const std::string& node) {
  const VirtualDisplay display;
  QApplication application(argc, argv);
  return runTests(argc, argv, node, 4);
}

}  // namespace laparoscope_servo::test_support
