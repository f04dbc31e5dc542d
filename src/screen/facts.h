// What the nodes have said, as the screen shows it. The screen knows nothing else. No ROS and no widgets here.
//
// Times `…_at` are s of a steady clock; negative: never. Stamps are ns of ROS time.
#pragma once

#include <QImage>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace laparoscope_servo::screen {

constexpr double kNever = -1.0;

struct TrackerFacts {
  bool connected = false;
  double heard_at = kNever;
  std::string state;  // of TrackerState
  std::string reason;
  std::string view;
  int width = 0;  // px, of the images; 0: not known
  int height = 0;
  std::int64_t reference_stamp = 0;
  std::array<double, 8> region{};  // px, in the reference image
};

struct ControllerFacts {
  bool connected = false;
  double heard_at = kNever;  // its newest command: it repeats them, but not its state
  std::string state;         // of ControllerState
  std::string task;
  std::string reason;
  std::string caution;
  bool engaged = false;
};

struct RobotFacts {
  bool connected = false;
  double heard_at = kNever;
  std::string state;  // of OperatingState
  std::string reason;
};

// Of one image.
struct Result {
  std::int64_t stamp = 0;
  std::int64_t reference_stamp = 0;
  int state = 0;              // of Homography
  std::array<double, 9> g{};  // reference to current px
  std::array<double, 8> corners{};
  double visible_fraction = 0.0;
};

struct Areas {
  std::int64_t stamp = 0;
  int rows = 0;
  int columns = 0;
  std::vector<bool> covered;  // row by row
};

struct Picture {
  QImage image;  // null: none has come
  std::int64_t stamp = 0;
  double arrived_at = kNever;
  double changed_at = kNever;   // when a picture came that differs from the one before
  double age_at_arrival = 0.0;  // s, by its stamp
};

// Of a service.
struct Answer {
  std::string what;  // e.g. "Engage"
  std::string text;
  bool success = false;
  bool waiting = false;  // asked, not answered yet
};

// rad/s, m/s: what a slider's end stands for.
using Limits = std::array<double, 4>;

struct Facts {
  bool master = false;  // there is one, or was when the screen connected
  TrackerFacts tracker;
  ControllerFacts controller;
  RobotFacts robot;
  Picture picture;
  std::optional<Result> result;  // of the picture's image
  std::optional<Areas> areas;    // the same
  Answer answer;                 // the newest
  bool dead_man_wanted = false;  // somebody listens to the dead-man switch
  std::optional<Limits> limits;  // pan, tilt, spin, insertion
};

}  // namespace laparoscope_servo::screen
