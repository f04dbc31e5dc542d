// The program of the screen in its own window.
#include <ros/init.h>

#include <QApplication>
#include <QScreen>
#include <QTimer>
#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <utility>

#include "ros/common/unblocked_output.h"
#include "screen/screen_widget.h"
#include "screen/small_window.h"

namespace {

// An exception from an event handler would end the program, and with it perhaps the only STOP button in reach.
class SturdyApplication : public QApplication {
 public:
  using QApplication::QApplication;
  bool notify(QObject* object, QEvent* event) override {
    try {
      return QApplication::notify(object, event);
    } catch (const std::exception& error) {
      std::cerr << "the screen: " << error.what() << std::endl;
      return false;
    }
  }
};

// Set by the signal handler, which may do nothing else; a timer reads it.
volatile std::sig_atomic_t asked_to_end = 0;
void askToEnd(int) {
  asked_to_end = 1;
}

}  // namespace

int main(int argc, char** argv) {
  const laparoscope_servo::UnblockedOutput output;
  ros::init(argc, argv, "laparoscope_screen", ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  // It draws without OpenGL, whose driver would be loaded all the same: 50 MB of 166 where LLVM draws for it.
  if (!qEnvironmentVariableIsSet("QT_XCB_GL_INTEGRATION")) qputenv("QT_XCB_GL_INTEGRATION", "none");
  SturdyApplication application(argc, argv);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, askToEnd);
  QTimer look;
  QObject::connect(&look, &QTimer::timeout, &application, [] {
    if (asked_to_end != 0 || !ros::ok()) QApplication::quit();
  });
  look.start(100);
  using namespace laparoscope_servo::screen;
  auto screen = std::make_unique<ScreenWidget>();
  const QSize room = QGuiApplication::primaryScreen()->availableSize();
  const QSize least = screen->minimumSizeHint();
  const bool fits = least.width() <= room.width() && least.height() <= room.height();
  std::unique_ptr<QWidget> window;
  if (fits) {
    window = std::move(screen);
  } else {
    window = std::make_unique<SmallWindow>(screen.release());
  }
  window->setWindowTitle("Laparoscope");
  window->resize(QSize(1280, 800).boundedTo(room));
  window->show();
  return SturdyApplication::exec();
}
