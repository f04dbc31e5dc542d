// A display of the test's own, and hands on its mouse and keyboard: Xvfb and xdotool. No window manager is needed.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QGuiApplication>
#include <QPoint>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::test_support {

class VirtualDisplay {
 public:
  // Sets DISPLAY; to be made before the QApplication. `wanted`: WIDTHxHEIGHT; empty: 1600x1000, twice that for a
  // QT_SCALE_FACTOR of 2.
  explicit VirtualDisplay(const std::string& wanted = "") {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) {
      const int null = ::open("/dev/null", O_WRONLY);
      ::dup2(null, STDERR_FILENO);
      const std::string descriptor = std::to_string(pipe_ends[1]);
      const std::string size = !wanted.empty()                             ? wanted
                               : std::getenv("QT_SCALE_FACTOR") == nullptr ? "1600x1000"
                                                                           : "3200x2000";
      ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", (size + "x24").c_str(), "-nolisten",
               "tcp", nullptr);
      ::_exit(127);
    }
    ::close(pipe_ends[1]);
    std::string number;
    for (char letter = 0; ::read(pipe_ends[0], &letter, 1) == 1 && letter != '\n';) number += letter;
    ::close(pipe_ends[0]);
    if (number.empty()) throw std::runtime_error("Xvfb does not start; is it installed?");
    ::setenv("DISPLAY", (":" + number).c_str(), 1);
    ::setenv("QT_QPA_PLATFORM", "xcb", 1);
  }
  ~VirtualDisplay() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

 private:
  pid_t process_ = -1;
};

// Real events of the X server. Each returns when xdotool has ended.
inline void hands(const std::string& commands) {
  if (std::system(("xdotool " + commands).c_str()) != 0) throw std::runtime_error("xdotool failed: " + commands);
}

// Qt's pixels are not the display's where QT_SCALE_FACTOR says so.
inline std::string moveTo(const QPoint& at) {
  const QPoint pixel = (QPointF(at) * qGuiApp->devicePixelRatio()).toPoint();
  return "mousemove " + std::to_string(pixel.x()) + " " + std::to_string(pixel.y()) + " ";
}

}  // namespace laparoscope_servo::test_support
