// The content of the nodes' messages that the screen shows; the screen has no other state. Uses no ROS and no widgets.
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

#include "screen/features/feature_facts.h"

namespace laparoscope_servo::screen {

constexpr double kNever = -1.0;

struct TrackerFacts {
  bool connected = false;
  double heard_at = kNever;
  double result_at = kNever;  // of its newest result: one comes for each image
  std::string state;          // of TrackerState
  std::string reason;
  std::string view;
  int width = 0;  // px, of the images; 0: not known
  int height = 0;
  std::int64_t reference_stamp = 0;
  std::array<double, 8> region{};  // px, in the reference image
  QRect proposal;                  // px, in the reference image: would do instead of the region; empty: none
};

struct ControllerFacts {
  bool connected = false;
  double heard_at = kNever;  // time of its newest command, since it publishes commands regularly, but not its state
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

// The tracker's result for one image.
struct Result {
  std::int64_t stamp = 0;
  std::int64_t reference_stamp = 0;
  int state = 0;              // of Homography
  std::array<double, 9> g{};  // reference to current px
  std::array<double, 8> corners{};
  double visible_fraction = 0.0;
  bool calibrated = false;  // the camera's intrinsics are known
};

struct Areas {
  std::int64_t stamp = 0;
  int rows = 0;
  int columns = 0;
  std::vector<bool> covered;             // row by row
  std::vector<std::uint8_t> cause = {};  // of AreaSelection, row by row; empty: not in the message
};

struct Picture {
  QImage image;  // null: no picture has come
  std::int64_t stamp = 0;
  double arrived_at = kNever;
  double changed_at = kNever;   // when a picture came that differs from the last one
  double age_at_arrival = 0.0;  // s, by its stamp
  QSize original;               // px, of its image; empty: as the region's tracker says
};

// The tracker's answer about a region before it is selected.
struct Verdict {
  QRect region;            // px of the original image
  std::int64_t stamp = 0;  // stamp of the frozen picture; 0: the live one
  bool taken = false;      // it would be accepted
  std::string why;         // why not
  QRect proposal = {};     // px, a region that would be accepted; empty if none is known
};

// A region that was drawn, and that the tracker was asked to select.
struct Drawn {
  QRect region;            // px of the original image
  std::int64_t stamp = 0;  // as of Verdict
};

// A region that the tracker names in place of one that was refused or could not be held.
struct Offer {
  QRect region;            // px of the image with this stamp
  std::int64_t stamp = 0;  // 0: the live one
  bool not_held = false;   // the selected region was lost; otherwise one was refused

  bool operator==(const Offer& other) const {
    return region == other.region && stamp == other.stamp && not_held == other.not_held;
  }
};

// A picture kept by the tracker, in which a region is drawn.
struct Frozen {
  QImage image;
  std::int64_t stamp = 0;
  QSize size;          // px, of the original image
  double at = kNever;  // when it came
};

// State of the player of a recording.
struct PlaybackFacts {
  bool connected = false;
  std::string state;      // of PlaybackState
  std::string reason;     // why it is FAILED
  double position = 0.0;  // s
  double duration = 0.0;  // s; 0: not known
  double period = 0.0;    // s from one picture to the next; 0: not known
};

// The recorder of a case.
struct RecorderFacts {
  double heard_at = kNever;
  int level = 0;  // of DiagnosticStatus
  std::string message;
  std::string file;           // without its folder
  std::string written, free;  // MB
};

struct StoredView {
  std::string name;
  std::int64_t stamp = 0;
  QImage thumbnail;
  QSize size;  // px, of the original image
  QRect roi;   // px, in it
  std::vector<std::string> leads_to;
};

// A parameter that may change while its node runs, from the node's description.
struct LiveParameter {
  std::string node;     // "tracker"
  std::string name;     // name in dynamic_reconfigure: quality__min_zncc
  std::string type;     // bool, int, double, str
  std::string meaning;  // with range and unit
  std::string value;
  double low = 0.0;  // of int and double
  double high = 0.0;
};

// State of a service call, or of STOP.
enum class Outcome { kWaiting, kDone, kRefused, kUnanswered };
struct Answer {
  std::string what;  // e.g. "Engage"
  std::string text;
  Outcome outcome = Outcome::kWaiting;
};

// rad/s, m/s: velocities at the ends of the sliders.
using Limits = std::array<double, 4>;

struct Facts {
  bool master = false;  // there is a master, or was when the screen connected
  TrackerFacts tracker;
  ControllerFacts controller;
  RobotFacts robot;
  Picture picture;
  std::optional<Result> result;    // result for the image of the picture
  std::optional<Areas> areas;      // its areas
  std::optional<Result> recorded;  // the recorded result for this image
  Answer answer;                   // the newest service call
  bool dead_man_wanted = false;    // a node subscribes to the dead-man switch
  std::optional<Limits> limits;    // pan, tilt, spin, insertion
  PlaybackFacts playback;
  RecorderFacts recorder;
  std::optional<Verdict> verdict;
  std::optional<Drawn> drawn;  // the newest one, until a region is taken
  std::optional<Frozen> frozen;
  std::shared_ptr<const std::vector<StoredView>> views;          // null: not known
  std::shared_ptr<const std::vector<LiveParameter>> parameters;  // null: not known
  std::vector<FeatureTrackerFacts> features;                     // by name
  double max_image_age = kNever;  // s, above which the controller stops; negative: not known
};

}  // namespace laparoscope_servo::screen
