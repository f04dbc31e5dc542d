#include "screen/band_text.h"

#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <laparoscope_servo/TrackerState.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ros/playback/corners_apart.h"
#include "ros/reasons/reason_table.h"
#include "screen/picture_words.h"
#include "screen/task_words.h"

namespace laparoscope_servo::screen {

namespace {

// s without a message after which a connected node counts as hung. The tracker publishes its state once a second, the
// trackers of features a result for each image, the others their states or commands at least ten times a second.
constexpr double kTrackerSilence = 2.5;
constexpr double kFeatureSilence = 1.0;
constexpr double kSilence = 0.5;
constexpr double kTrackerPatience = 1.0;  // s without an image, after which the tracker says NO_IMAGE

std::string percent(double share) {
  return std::isfinite(share) ? std::to_string(std::lround(100.0 * share)) + " %" : "?";
}

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 9.95 ? "%.1f s" : "%.0f s", std::min(value, 1e6));
  return text;
}

// Text for a node from which no message has come yet, or that is silent; empty if it publishes.
BandText absence(const Facts& facts, const std::string& who, bool connected, double heard_at, double patience,
                 double now) {
  if (!facts.master) return {"NO MASTER", "There is no ROS master.", "Start a launch file; the screen waits.", "", {}};
  if (!connected && heard_at < 0.0)
    return {"ABSENT", "No " + who + " is running.", "Start one by a launch file.", "", {}};
  if (!connected) return {"GONE", "The " + who + " has ended.", "Start it again.", "", Level::kBad};
  if (heard_at < 0.0) return {"WAITING", "The " + who + " has not spoken yet.", "Wait.", "", {}};
  if (!(now - heard_at <= patience))
    return {"SILENT", "The " + who + " has said nothing for " + seconds(now - heard_at) + ".",
            "Look at its terminal; start it again.", "", Level::kBad};
  return {};
}

void explainTo(BandText& band, Speaker speaker, const std::string& reason) {
  band.detail = reason;
  const ReasonRow* row = explain(speaker, reason);
  band.sentence = row != nullptr ? row->sentence : reason;
  band.cure = row != nullptr ? row->cure : reason.empty() ? "" : "See doc/troubleshooting.md.";
}

// How far what is computed now is from what was recorded.
std::string besideRecorded(const Facts& facts) {
  if (!facts.result || !facts.recorded) return "";
  const bool tracks = facts.result->state == Homography::TRACKING;
  const bool tracked = facts.recorded->state == Homography::TRACKING;
  if (!tracks || !tracked) return tracks ? "Recorded: not tracked." : tracked ? "Recorded: tracked." : "";
  char text[64];
  std::snprintf(text, sizeof text, "Recorded: %.2f px away.",
                cornersApart(facts.result->corners, facts.recorded->corners));
  return text;
}

// No camera has failed where a recording does not play, cannot be read, or plays more slowly than the tracker waits for
// an image. Empty while it plays, and without one.
BandText standingRecording(const PlaybackFacts& playback) {
  if (!playback.connected) return {};
  if (playback.state == "ENDED")
    return {"ENDED", "The recording has ended.", "Press \"Again\", or take the slider below the picture to a place.",
            "", Level::kResting};
  if (playback.state == "HOLDING")
    return {"HOLDS", "The recording holds its first picture.", "Draw a region in it, or press \"Play\".", "",
            Level::kResting};
  if (playback.state == "PAUSED")
    return {"PAUSED", "The recording is paused.", "Press \"Play\" or \"Step\".", "", Level::kResting};
  if (playback.state == "PLAYING" && playback.period > kTrackerPatience)
    return {"PLAYS", "The recording plays slowly: one picture in " + seconds(playback.period) + ".", "Wait.", "",
            Level::kResting};
  if (playback.state == "FAILED") {
    BandText failed{"UNREADABLE", "", "", "", Level::kBad};
    explainTo(failed, Speaker::kPlayer, playback.reason);
    return failed;
  }
  if (playback.state == "WAITING") return {"WAITING", "The recording has not begun yet.", "Wait.", "", Level::kResting};
  return {};
}

// The tracker publishes its state once a second only, and says that no image comes after a second: what it said last of
// the pictures is true only while results come. Empty while they do.
BandText staleness(const Facts& facts, double now) {
  const TrackerFacts& tracker = facts.tracker;
  const bool of_pictures = tracker.state != TrackerState::NO_IMAGE && tracker.state != TrackerState::NOT_STARTED;
  const double age = now - tracker.result_at;
  if (!of_pictures || tracker.result_at < 0.0 || age <= oldestLive(facts.playback)) return {};
  if (BandText recording = standingRecording(facts.playback); !recording.word.empty()) return recording;
  return {"NO RESULT", "No picture has been looked at for " + seconds(age) + ". Before: " + tracker.state + ".",
          "Wait a moment: it will be said whether camera or tracker have stopped.", tracker.reason, Level::kWaiting};
}

// The expected error of the feature that is known worst, in words; empty when it is not known.
std::string expectedError(const FeatureResult& result) {
  double worst = 0.0;
  for (const FeatureFact& feature : result.features) worst = std::max(worst, feature.expected_error);
  if (!(std::isfinite(worst) && worst > 0.0)) return "";
  char text[64];
  std::snprintf(text, sizeof text, ", to %.2g px or better", worst);
  return text;
}

// The feature that the reason begins with, and a colon; empty when it begins with none.
std::string concernedId(const FeatureResult& result) {
  for (const FeatureFact& feature : result.features) {
    const std::string beginning = feature.id + ": ";
    if (result.reason.compare(0, beginning.size(), beginning) == 0) return beginning;
  }
  return "";
}

}  // namespace

BandText trackerBand(const Facts& facts, double now) {
  const TrackerFacts& tracker = facts.tracker;
  BandText band = absence(facts, "tracker", tracker.connected, tracker.heard_at, kTrackerSilence, now);
  if (!band.word.empty()) return band;
  if (BandText stale = staleness(facts, now); !stale.word.empty()) return stale;
  band.word = tracker.state;
  for (char& letter : band.word) letter = letter == '_' ? ' ' : letter;
  explainTo(band, Speaker::kTracker, tracker.reason);
  band.level = Level::kBad;
  if (tracker.state == "NO_IMAGE" && tracker.reason.find("image refused: ") == std::string::npos) {
    BandText recording = standingRecording(facts.playback);
    if (recording.detail.empty()) recording.detail = tracker.reason;
    if (!recording.word.empty()) return recording;
  }
  if (tracker.state == "IDLE") band.level = Level::kResting;
  if (tracker.state == "SEARCHING") band.level = Level::kWaiting;
  if (tracker.state == "TRACKING") {
    band.level = Level::kGood;
    band.sentence = "The region is followed.";
    if (facts.result) band.sentence += " " + percent(facts.result->visible_fraction) + " of it is visible.";
    band.cure.clear();
    if (facts.result && !facts.result->calibrated && facts.controller.connected)
      band.cure = "Without the camera's calibration the controller cannot use it.";
  }
  if (const std::string beside = besideRecorded(facts); !beside.empty())
    band.cure += (band.cure.empty() ? "" : " ") + beside;
  if (!tracker.view.empty()) band.cure += (band.cure.empty() ? "" : " ") + ("View: " + tracker.view + ".");
  return band;
}

BandText featureBand(const Facts& facts, const FeatureTrackerFacts& tracker, double now) {
  BandText band = absence(facts, "tracker " + tracker.name, tracker.connected, tracker.heard_at, kFeatureSilence, now);
  if (band.word == "SILENT") {
    if (const BandText recording = standingRecording(facts.playback); !recording.word.empty()) return recording;
    band.sentence = "It has said nothing for " + seconds(now - tracker.heard_at) + ".";
    band.cure = "Does the camera send? If so, look at the tracker's terminal.";
  }
  if (!band.word.empty()) return band;
  const FeatureResult& result = *tracker.newest;
  explainTo(band, Speaker::kFeatures, result.reason);
  band.word = "?";
  band.level = Level::kBad;
  const auto seen = std::count_if(result.features.begin(), result.features.end(), [](const FeatureFact& feature) {
    return feature.state == TrackedFeatures::TRACKING;
  });
  const std::string count = std::to_string(seen) + " of " + std::to_string(result.features.size());
  if (result.state == TrackedFeatures::IDLE) {
    band.word = "IDLE";
    band.level = Level::kResting;
  } else if (result.state == TrackedFeatures::TRACKING) {
    band.word = "TRACKING " + count;
    band.level = Level::kGood;
    band.sentence = "All are seen" + expectedError(result) + ".";
    band.cure.clear();
  } else if (result.state == TrackedFeatures::SEARCHING || result.state == TrackedFeatures::LOST) {
    const bool lost = result.state == TrackedFeatures::LOST;
    band.word = (lost ? "LOST " : "SEARCHING ") + count;
    band.level = lost ? Level::kBad : Level::kWaiting;
    band.sentence = concernedId(result) + band.sentence;
  }
  return band;
}

bool controllerSpeaks(const Facts& facts, double now) {
  const ControllerFacts& controller = facts.controller;
  return absence(facts, "", controller.connected, controller.heard_at, kSilence, now).word.empty();
}

BandText controllerBand(const Facts& facts, double now) {
  const ControllerFacts& controller = facts.controller;
  BandText band = absence(facts, "controller", controller.connected, controller.heard_at, kSilence, now);
  if (!band.word.empty()) return band;
  if (controller.state.empty()) return {"WAITING", "The controller has not told its state yet.", "Wait.", "", {}};
  const TaskWords* task = wordsOfTask(controller.task);
  band.note = "Task: " + nameOfTask(controller.task);
  band.word = controller.state;
  explainTo(band, Speaker::kController, controller.reason);
  band.level = Level::kBad;
  if (controller.state == "IDLE") band.level = Level::kResting;
  if (controller.state == "ARMED" || controller.state == "HOLD") band.level = Level::kWaiting;
  if (controller.state == "SERVO") {
    band.level = Level::kGood;
    band.sentence = task != nullptr ? task->serves : "The scope does its task.";
    band.cure.clear();
    if (!controller.caution.empty()) {
      explainTo(band, Speaker::kController, controller.caution);
      band.level = Level::kWaiting;
    }
  }
  return band;
}

BandText robotBand(const Facts& facts, double now) {
  const RobotFacts& robot = facts.robot;
  BandText band = absence(facts, "robot's node", robot.connected, robot.heard_at, kSilence, now);
  if (!band.word.empty()) return band;
  band.word = robot.state;
  explainTo(band, Speaker::kRobot, robot.reason);
  band.level = Level::kBad;
  if (robot.state == "DISABLED") band.level = Level::kResting;
  if (robot.state == "PAUSED") band.level = Level::kWaiting;
  if (robot.state == "ENABLED") {
    band.level = robot.reason.empty() ? Level::kGood : Level::kWaiting;
    if (robot.reason.empty()) band.sentence = "The arm does what it is told.";
  }
  return band;
}

}  // namespace laparoscope_servo::screen
