// What the nodes have said, as the screen shows it. The screen knows nothing else. No ROS and no widgets here.
//
// Times `…_at` are s of a steady clock; negative: never. Stamps are ns of ROS time.
#pragma once

#include <QImage>
#include <QRect>
#include <QSize>
#include <array>
#include <cstdint>
#include <memory>
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
  std::vector<bool> covered;             // row by row
  std::vector<std::uint8_t> cause = {};  // of AreaSelection, row by row; empty: it is not told
};

struct Picture {
  QImage image;  // null: none has come
  std::int64_t stamp = 0;
  double arrived_at = kNever;
  double changed_at = kNever;   // when a picture came that differs from the one before
  double age_at_arrival = 0.0;  // s, by its stamp
};

// What the tracker says of a region before it is selected.
struct Verdict {
  QRect region;            // px of the original image
  std::int64_t stamp = 0;  // of the picture that is frozen; 0: the live one
  bool taken = false;      // it would be
  std::string why;         // not
  QRect proposal;          // px: one that would be; empty where none is known
};

// A picture that the tracker keeps, to draw a region in.
struct Frozen {
  QImage image;
  std::int64_t stamp = 0;
  QSize size;          // px, of the original image
  double at = kNever;  // when it came
};

// Of a recording.
struct PlaybackFacts {
  bool connected = false;
  std::string state;      // of PlaybackState
  double position = 0.0;  // s
  double duration = 0.0;  // s; 0: not known
};

struct StoredView {
  std::string name;
  std::int64_t stamp = 0;
  QImage thumbnail;
  QSize size;  // px, of the original image
  QRect roi;   // px, in it
  std::vector<std::string> leads_to;
};

// A parameter that may change while its node runs, as the node describes it.
struct LiveParameter {
  std::string node;     // "tracker"
  std::string name;     // as reconfigure has it: quality__min_zncc
  std::string type;     // bool, int, double, str
  std::string meaning;  // with range and unit
  std::string value;
  double low = 0.0;  // of int and double
  double high = 0.0;
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
  std::optional<Result> result;    // of the picture's image
  std::optional<Areas> areas;      // the same
  std::optional<Result> recorded;  // what a tracker had said of it when it was recorded
  Answer answer;                   // the newest
  bool dead_man_wanted = false;    // somebody listens to the dead-man switch
  std::optional<Limits> limits;    // pan, tilt, spin, insertion
  PlaybackFacts playback;
  std::optional<Verdict> verdict;
  std::optional<Frozen> frozen;
  std::shared_ptr<const std::vector<StoredView>> views;          // null: not known
  std::shared_ptr<const std::vector<LiveParameter>> parameters;  // the same
  double max_image_age = kNever;  // s, above which the controller stops; negative: not known
};

}  // namespace laparoscope_servo::screen
