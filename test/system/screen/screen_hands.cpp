// How long it takes from a hand to what another process hears: STOP, the dead-man switch by button and by key, each
// slider. Run by scripts/measure_screen in front of the simulated cart; no test.
//
//   screen_hands TIMES SECONDS_HELD
//
// Events are the X server's (XTest); who listens is another process. Writes lines `name,seconds` to stdout.
#include <dlfcn.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/SelectTask.h>
#include <std_msgs/Bool.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <sys/stat.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <thread>
#include <vector>

#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo {
namespace {

const char* const kSliders[] = {"Pan", "Tilt", "Spin", "Insertion"};

bool isZero(const ScopeVelocity& v) {
  return v.pan == 0.0 && v.tilt == 0.0 && v.spin == 0.0 && v.insertion == 0.0;
}

// The other process: a line for each message, with its time of a clock that all processes share.
int listen(int argc, char** argv) {
  ros::init(argc, argv, "screen_listener");
  ros::NodeHandle node;
  const auto say = [](const char* topic, bool moves) {
    std::printf("%s %d %.6f\n", topic, moves ? 1 : 0, steadyNow());
    std::fflush(stdout);
  };
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  const ros::Subscriber command = node.subscribe<ScopeVelocity>(
      "servo_command", 100, [&](const ScopeVelocityConstPtr& v) { say("command", !isZero(*v)); }, {}, no_delay);
  const ros::Subscriber manual = node.subscribe<ScopeVelocity>(
      "controller/manual", 100, [&](const ScopeVelocityConstPtr& v) { say("slider", !isZero(*v)); }, {}, no_delay);
  const ros::Subscriber held = node.subscribe<std_msgs::Bool>(
      "dead_man", 100, [&](const std_msgs::BoolConstPtr& b) { say("dead_man", b->data != 0); }, {}, no_delay);
  ros::spin();
  return 0;
}

// Without the libraries' headers, which nothing else here needs.
class Hand {
 public:
  Hand() {
    void* x = ::dlopen("libX11.so.6", RTLD_NOW);
    void* test = ::dlopen("libXtst.so.6", RTLD_NOW);
    if (x == nullptr || test == nullptr) throw std::runtime_error("libX11.so.6 and libXtst.so.6 are needed");
    display_ = reinterpret_cast<void* (*)(const char*)>(::dlsym(x, "XOpenDisplay"))(nullptr);
    flush_ = reinterpret_cast<int (*)(void*)>(::dlsym(x, "XFlush"));
    button_ = reinterpret_cast<int (*)(void*, unsigned, int, unsigned long)>(::dlsym(test, "XTestFakeButtonEvent"));
    key_ = reinterpret_cast<int (*)(void*, unsigned, int, unsigned long)>(::dlsym(test, "XTestFakeKeyEvent"));
    code_ = reinterpret_cast<unsigned char (*)(void*, unsigned long)>(::dlsym(x, "XKeysymToKeycode"));
    motion_ = reinterpret_cast<int (*)(void*, int, int, int, unsigned long)>(::dlsym(test, "XTestFakeMotionEvent"));
    if (display_ == nullptr) throw std::runtime_error("no display");
  }
  void move(const QPoint& at) { motion_(display_, -1, at.x(), at.y(), 0), flush_(display_); }
  double button(bool down) {
    const double now = steadyNow();
    button_(display_, 1, down ? 1 : 0, 0), flush_(display_);
    return now;
  }
  double f9(bool down) {
    constexpr unsigned long kF9 = 0xffc6;  // XK_F9
    const double now = steadyNow();
    key_(display_, code_(display_, kF9), down ? 1 : 0, 0), flush_(display_);
    return now;
  }

 private:
  void* display_;
  int (*flush_)(void*);
  int (*button_)(void*, unsigned, int, unsigned long);
  int (*key_)(void*, unsigned, int, unsigned long);
  unsigned char (*code_)(void*, unsigned long);
  int (*motion_)(void*, int, int, int, unsigned long);
};

// Another hand, on controller/manual; no two words are alike, or it would count as a stick out of reach.
class Stick {
 public:
  Stick() {
    thread_ = std::thread([this] {
      for (ros::WallRate rate(50.0); !ends_ && ros::ok(); rate.sleep()) {
        const double speed = speed_;
        command_.pan = speed == 0.0 ? 0.0 : speed + 1e-6 * (command_.header.seq % 2);
        say();
      }
    });
  }
  ~Stick() {
    ends_ = true;
    thread_.join();
    command_.pan = 0.0;
    say();
  }
  // The controller wants to see it at rest first.
  void rest() { speed_ = 0.0; }
  void push(double speed) { speed_ = speed; }  // rad/s

 private:
  void say() {
    ++command_.header.seq;
    command_.header.stamp = ros::Time::now();
    publisher_.publish(command_);
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_ = node_.advertise<ScopeVelocity>("controller/manual", 1);
  ScopeVelocity command_;
  std::atomic<double> speed_{0.0};  // rad/s
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

struct Heard {
  bool moves = false;
  double since = -1.0;  // s, when this began
};

class Measurement {
 public:
  Measurement(const std::string& program, int times, double held) : times_(times), held_(held) {
    const std::string pipe = folder_.file("ears");
    if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe " + pipe);
    ears_ = std::make_unique<test::ChildProcess>(program, std::vector<std::string>{"--listen"}, pipe);
    reader_ = std::thread([this, pipe] { read(pipe); });
  }
  ~Measurement() {
    ears_.reset();
    reader_.join();
  }

  void run(const std::map<std::string, QPoint>& places) {
    call<SelectTask>("controller/select_task", [](SelectTask& task) { task.request.task = "MANUAL"; });
    stop(places.at("stop"));
    const auto button = [this](bool down) { return hand_.button(down); };
    const auto key = [this](bool down) { return hand_.f9(down); };
    const QPoint dead_man = places.at("dead_man"), picture = places.at("image");
    release("dead_man", "dead_man_button", dead_man, dead_man, button);
    for (const char* const slider : kSliders) {
      const QPoint place = places.at(slider);
      release("slider", std::string("slider_") + slider, place, place + QPoint(60, 0), button);
    }
    hold("false_releases_button", dead_man, button);
    hand_.move(picture);  // a click there gives the screen the focus, and draws nothing
    ros::WallDuration(0.2).sleep();
    hand_.button(true);
    hand_.button(false);
    ros::WallDuration(0.5).sleep();
    release("dead_man", "dead_man_key", picture, picture, key);
    hold("false_releases_key", picture, key);
  }

 private:
  template <class Service, class Fill>
  bool call(const std::string& name, const Fill& fill) {
    Service call;
    fill(call);
    return ros::service::call(name, call) && call.response.success;
  }
  void read(const std::string& pipe) {
    std::ifstream lines(pipe);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string topic;
      int moves = 0;
      double at = 0.0;
      if (!(words >> topic >> moves >> at)) continue;  // a word of its log
      const std::lock_guard<std::mutex> lock(mutex_);
      Heard& heard = heard_[topic];
      if (heard.since < 0.0 || heard.moves != (moves != 0)) heard = {moves != 0, at};
      if (moves == 0) ++zeros_[topic];
    }
  }
  Heard heard(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return heard_[topic];
  }
  bool wait(const std::function<bool()>& condition, double seconds = 20.0) {
    const double until = steadyNow() + seconds;
    while (!condition() && steadyNow() < until && ros::ok()) ros::WallDuration(0.001).sleep();
    return condition();
  }
  void tell(const std::string& name, double seconds) { std::cout << name << ',' << seconds << std::endl; }

  // A stick that drives the scope to and fro, so that there is a motion to be stopped as often as is wanted.
  void stop(const QPoint& place) {
    Stick stick;
    for (int k = 0; k < times_ && ros::ok(); ++k) {
      const bool moves = wait([&] {
        stick.rest();
        call<std_srvs::Trigger>("aesop/enable", [](std_srvs::Trigger&) {});
        call<std_srvs::SetBool>("controller/engage", [](std_srvs::SetBool& engage) { engage.request.data = 1; });
        ros::WallDuration(0.2).sleep();
        stick.push(k % 2 == 0 ? 0.02 : -0.02);
        return wait([&] { return heard("command").moves; }, 2.0);
      });
      if (!moves) {
        std::cerr << "the controller does not move the scope" << std::endl;
        return;
      }
      hand_.move(place);
      ros::WallDuration(0.2).sleep();
      const double pressed = hand_.button(true);
      if (wait([&] { return !heard("command").moves; })) tell("stop", heard("command").since - pressed);
      hand_.button(false);
    }
  }
  void release(const std::string& topic, const std::string& name, const QPoint& from, const QPoint& to,
               const std::function<double(bool)>& press) {
    for (int k = 0; k < times_ && ros::ok(); ++k) {
      hand_.move(from);
      ros::WallDuration(0.1).sleep();
      press(true);
      hand_.move(to);
      if (!wait([&] { return heard(topic).moves; })) {
        std::cerr << name << " cannot be held" << std::endl;
        press(false);
        return;
      }
      ros::WallDuration(0.3).sleep();
      const double released = press(false);
      if (wait([&] { return !heard(topic).moves; })) tell(name, heard(topic).since - released);
    }
  }
  void hold(const std::string& name, const QPoint& place, const std::function<double(bool)>& press) {
    hand_.move(place);
    press(true);
    if (!wait([&] { return heard("dead_man").moves; })) {
      std::cerr << name << ": it cannot be held" << std::endl;
      press(false);
      return;
    }
    const int before = zeros("dead_man");
    ros::WallDuration(held_).sleep();
    tell(name, zeros("dead_man") - before);
    press(false);
    wait([&] { return !heard("dead_man").moves; });
  }
  int zeros(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return zeros_[topic];
  }

  int times_;
  double held_;
  Hand hand_;
  test_support::TemporaryFolder folder_;
  std::unique_ptr<test::ChildProcess> ears_;
  std::mutex mutex_;
  std::map<std::string, Heard> heard_;
  std::map<std::string, int> zeros_;
  std::thread reader_;
};

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  using namespace laparoscope_servo;
  if (argc > 1 && std::string(argv[1]) == "--listen") return listen(argc, argv);
  if (argc < 3) {
    std::cerr << "screen_hands TIMES SECONDS_HELD" << std::endl;
    return 2;
  }
  ros::init(argc, argv, "screen_hands");
  const test_support::VirtualDisplay display;
  QApplication application(argc, argv);
  screen::ScreenWidget screen;
  screen.move(0, 0);
  screen.resize(1280, 800);
  screen.show();
  test_support::waitFor([&] { return screen.windowHandle()->isExposed(); });
  test_support::hands("windowfocus " + std::to_string(screen.winId()));
  const auto centre = [&](const QString& name) {
    auto* widget = screen.findChild<QWidget*>(name);
    return widget->mapToGlobal(widget->rect().center());
  };
  std::map<std::string, QPoint> places{
      {"stop", centre("stop")}, {"dead_man", centre("dead_man")}, {"image", centre("image")}};
  for (const char* const slider : kSliders) places[slider] = centre(slider);
  std::thread work([&, program = std::string(argv[0]), times = std::stoi(argv[1]), held = std::stod(argv[2])] {
    try {
      Measurement(program, times, held).run(places);
    } catch (const std::exception& error) {
      std::cerr << error.what() << std::endl;
    }
    QMetaObject::invokeMethod(
        &application, [] { QApplication::quit(); }, Qt::QueuedConnection);
  });
  QApplication::exec();
  work.join();
  ros::shutdown();
  return 0;
}
