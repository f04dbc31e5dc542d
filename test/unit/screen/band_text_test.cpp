#include "screen/band_text.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/TrackedFeatures.h>

#include <memory>
#include <set>

namespace laparoscope_servo::screen {
namespace {

constexpr double kNow = 1000.0;

Facts facts() {
  Facts facts;
  facts.master = true;
  facts.tracker.connected = facts.controller.connected = facts.robot.connected = true;
  facts.tracker.heard_at = facts.controller.heard_at = facts.robot.heard_at = kNow - 0.1;
  facts.tracker.state = "TRACKING";
  facts.controller.state = "SERVO";
  facts.controller.task = "HOLD_VIEW";
  facts.controller.reason = "engaged, nothing is missing";
  facts.robot.state = "ENABLED";
  return facts;
}

TEST(BandText, AllIsWell) {
  Facts all = facts();
  all.result = Result();
  all.result->visible_fraction = 0.874;
  all.result->calibrated = true;
  EXPECT_EQ(trackerBand(all, kNow).word, "TRACKING");
  EXPECT_EQ(trackerBand(all, kNow).level, Level::kGood);
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The region is followed. 87 % of it is visible.");
  EXPECT_EQ(controllerBand(all, kNow).word, "SERVO");
  EXPECT_EQ(controllerBand(all, kNow).sentence, "The scope follows the region.");
  EXPECT_EQ(robotBand(all, kNow).word, "ENABLED");
  EXPECT_EQ(robotBand(all, kNow).level, Level::kGood);
}

TEST(BandText, ACameraWithoutACalibrationIsSaidWhereAControllerNeedsOne) {
  Facts all = facts();
  all.result = Result();
  EXPECT_EQ(trackerBand(all, kNow).word, "TRACKING");
  EXPECT_EQ(trackerBand(all, kNow).cure, "Without the camera's calibration the controller cannot use it.");
  all.controller.connected = false;
  EXPECT_EQ(trackerBand(all, kNow).cure, "") << "a recording is tracked without one";
}

TEST(BandText, AReplayTellsHowFarItIsFromWhatWasRecorded) {
  Facts all = facts();
  all.result = Result();
  all.result->state = 1;  // TRACKING
  all.result->calibrated = true;
  all.recorded = all.result;
  EXPECT_EQ(trackerBand(all, kNow).cure, "Recorded: 0.00 px away.");
  all.recorded->corners[5] = 1.25;
  EXPECT_EQ(trackerBand(all, kNow).cure, "Recorded: 1.25 px away.");
  all.recorded->state = 2;  // SEARCHING
  EXPECT_EQ(trackerBand(all, kNow).cure, "Recorded: not tracked.");
  all.recorded.reset();
  EXPECT_EQ(trackerBand(all, kNow).cure, "");
}

TEST(BandText, EachStateHasItsWordReasonAndCure) {
  Facts all = facts();
  all.tracker.state = "NO_IMAGE";
  all.tracker.reason = "no image for more than 1 s; before: TRACKING";
  EXPECT_EQ(trackerBand(all, kNow).word, "NO IMAGE");
  EXPECT_EQ(trackerBand(all, kNow).level, Level::kBad);
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The camera has stopped sending.");
  EXPECT_FALSE(trackerBand(all, kNow).cure.empty());
  EXPECT_EQ(trackerBand(all, kNow).detail, all.tracker.reason);
  all.controller.state = "HOLD";
  all.controller.reason = "the robot is paused";
  EXPECT_EQ(controllerBand(all, kNow).level, Level::kWaiting);
  EXPECT_EQ(controllerBand(all, kNow).cure, "Press Resume.");
  all.robot.state = "FAULT";
  all.robot.reason = "fault: joint limit";
  EXPECT_EQ(robotBand(all, kNow).level, Level::kBad);
  EXPECT_EQ(robotBand(all, kNow).sentence, "The arm's controller has a fault.");
}

// Of a line of the trackers of features, whose features are `states`.
BandText lineOf(std::uint8_t state, const std::string& reason, const std::vector<int>& states) {
  auto result = std::make_shared<FeatureResult>();
  result->state = state;
  result->reason = reason;
  for (const int each : states) {
    FeatureFact& feature = result->features.emplace_back();
    feature.id = "shaft " + std::to_string(result->features.size());
    feature.state = each;
    feature.expected_error = 0.25;
  }
  FeatureTrackerFacts tracker{"edges", true, kNow - 0.1, result, nullptr};
  return featureBand(facts(), tracker, kNow);
}

TEST(BandText, ATrackerOfFeaturesHasALineOfWords) {
  const int tracking = TrackedFeatures::TRACKING, lost = TrackedFeatures::LOST;
  const BandText good = lineOf(TrackedFeatures::TRACKING, "", {tracking, tracking});
  EXPECT_EQ(good.word, "TRACKING 2 of 2");
  EXPECT_EQ(good.sentence, "All are seen, to 0.25 px or better.");
  EXPECT_EQ(good.cure, "");
  EXPECT_EQ(good.level, Level::kGood);
  const BandText bad = lineOf(TrackedFeatures::LOST, "shaft 2: outside the image", {tracking, lost});
  EXPECT_EQ(bad.word, "LOST 1 of 2");
  EXPECT_EQ(bad.sentence, "shaft 2: It has left the picture.");
  EXPECT_EQ(bad.cure, "Move the scope back.");
  EXPECT_EQ(bad.detail, "shaft 2: outside the image");
  EXPECT_EQ(bad.level, Level::kBad);
  EXPECT_EQ(lineOf(TrackedFeatures::SEARCHING, "shaft 1: outside the image", {TrackedFeatures::SEARCHING}).level,
            Level::kWaiting);
  const BandText idle = lineOf(TrackedFeatures::IDLE, "no instrument is seen", {});
  EXPECT_EQ(idle.word, "IDLE");
  EXPECT_EQ(idle.sentence, "No instrument is seen.");
  EXPECT_EQ(idle.level, Level::kResting);
  EXPECT_EQ(lineOf(77, "", {}).level, Level::kBad) << "a state that is none";
}

TEST(BandText, ATrackerOfFeaturesThatSaysNothingIsSaid) {
  FeatureTrackerFacts tracker;
  tracker.name = "edges";
  tracker.connected = true;
  EXPECT_EQ(featureBand(facts(), tracker, kNow).word, "WAITING");
  tracker.newest = std::make_shared<FeatureResult>();
  tracker.heard_at = kNow - 7.0;
  EXPECT_EQ(featureBand(facts(), tracker, kNow).word, "SILENT");
  EXPECT_EQ(featureBand(facts(), tracker, kNow).sentence, "It has said nothing for 7.0 s.");
  tracker.connected = false;
  EXPECT_EQ(featureBand(facts(), tracker, kNow).word, "GONE");
  EXPECT_NE(featureBand(facts(), tracker, kNow).sentence.find("edges"), std::string::npos);
  EXPECT_EQ(featureBand({}, tracker, kNow).word, "NO MASTER");
}

TEST(BandText, ARecordingThatStandsIsNoCameraThatFails) {
  Facts all = facts();
  all.tracker.state = "NO_IMAGE";
  all.tracker.reason = "no image for more than 1 s; before: TRACKING";
  all.playback.connected = true;
  FeatureTrackerFacts edges;
  edges.name = "edges";
  edges.connected = true;
  edges.newest = std::make_shared<FeatureResult>();
  edges.heard_at = kNow - 7.0;
  const std::pair<const char*, const char*> words[] = {
      {"ENDED", "ENDED"}, {"PAUSED", "PAUSED"}, {"HOLDING", "HOLDS"}, {"WAITING", "WAITING"}};
  for (const auto& [state, word] : words) {
    all.playback.state = state;
    const BandText band = trackerBand(all, kNow);
    EXPECT_EQ(band.word, word);
    EXPECT_EQ(band.level, Level::kResting) << state << ": nobody has to act";
    EXPECT_EQ(band.sentence.find("The recording "), 0u) << band.sentence;
    EXPECT_NE(band.cure, "");
    EXPECT_EQ(band.detail, all.tracker.reason);
    EXPECT_EQ(featureBand(all, edges, kNow).word, word) << "the trackers of features, too";
  }
  all.playback.state = "ENDED";
  EXPECT_NE(trackerBand(all, kNow).cure.find("\"Again\""), std::string::npos);
  all.playback.state = "PLAYING";
  EXPECT_EQ(trackerBand(all, kNow).word, "NO IMAGE");
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The camera has stopped sending.");
  EXPECT_EQ(featureBand(all, edges, kNow).word, "SILENT");
  all.playback.period = 2.0;
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The recording plays slowly: one picture in 2.0 s.");
  EXPECT_EQ(trackerBand(all, kNow).level, Level::kResting);
  all.playback.state = "ENDED";
  all.tracker.reason = "image refused: the image is truncated: it has 7 bytes";
  EXPECT_EQ(trackerBand(all, kNow).word, "NO IMAGE") << "what is wrong with its pictures is not hidden";
  all.playback.connected = false;
  all.tracker.reason = "no image for more than 1 s; before: TRACKING";
  EXPECT_EQ(trackerBand(all, kNow).level, Level::kBad) << "the player is gone";
}

TEST(BandText, TheControllersTaskIsSaidInEachOfItsStates) {
  Facts all = facts();
  const std::pair<const char*, const char*> tasks[] = {{"HOLD_VIEW", "The scope follows the region."},
                                                       {"MANUAL", "The scope is driven by hand."},
                                                       {"STABILISE", "The scope holds the whole view."},
                                                       {"CENTRE_TIP", "The scope keeps the tip near the middle."},
                                                       {"JUGGLE", "The scope does its task."}};
  std::set<std::string> notes;
  for (const auto& [task, sentence] : tasks) {
    all.controller.task = task;
    all.controller.state = "SERVO";
    EXPECT_EQ(controllerBand(all, kNow).sentence, sentence);
    const std::string note = controllerBand(all, kNow).note;
    EXPECT_EQ(note.find("Task: "), 0u) << note;
    notes.insert(note);
    for (const char* state : {"IDLE", "ARMED", "HOLD", "LOST", "FAULT"}) {
      all.controller.state = state;
      EXPECT_EQ(controllerBand(all, kNow).note, note) << state;
    }
  }
  EXPECT_EQ(notes.size(), 5u) << "each has a name of its own";
  EXPECT_EQ(notes.count("Task: JUGGLE"), 1u) << "one that the screen does not know is named as the controller names it";
  EXPECT_EQ(controllerBand(all, kNow + 10.0).note, "") << "a silent controller has no task";
  EXPECT_TRUE(controllerSpeaks(all, kNow));
  EXPECT_FALSE(controllerSpeaks(all, kNow + 10.0));
  EXPECT_EQ(trackerBand(all, kNow).note, "");
}

TEST(BandText, ACautionIsSaidWhileItMoves) {
  Facts all = facts();
  all.controller.caution = "slow: visible fraction below 0.5";
  EXPECT_EQ(controllerBand(all, kNow).word, "SERVO");
  EXPECT_EQ(controllerBand(all, kNow).level, Level::kWaiting);
  EXPECT_NE(controllerBand(all, kNow).sentence.find("slower"), std::string::npos);
}

TEST(BandText, AStateDoesNotOutliveItsNode) {
  Facts all = facts();
  EXPECT_EQ(trackerBand(all, kNow + 10.0).word, "SILENT");
  EXPECT_EQ(controllerBand(all, kNow + 10.0).word, "SILENT");
  EXPECT_EQ(robotBand(all, kNow + 10.0).word, "SILENT");
  all.tracker.connected = all.controller.connected = all.robot.connected = false;
  EXPECT_EQ(trackerBand(all, kNow).word, "GONE");
  EXPECT_EQ(controllerBand(all, kNow).word, "GONE");
  EXPECT_EQ(robotBand(all, kNow).word, "GONE");
  EXPECT_EQ(robotBand(all, kNow).level, Level::kBad);
}

TEST(BandText, ARecordingThatCannotBeReadSaysWhyAndWhatToDo) {
  Facts all = facts();
  all.tracker.state = "NO_IMAGE";
  all.tracker.reason = "no image has come yet";
  all.playback.connected = true;
  all.playback.state = "FAILED";
  all.playback.reason = "bag 'a.bag' breaks off: it was cut, or the recorder was killed (Error reading from file)";
  EXPECT_EQ(trackerBand(all, kNow).word, "UNREADABLE");
  EXPECT_EQ(trackerBand(all, kNow).level, Level::kBad);
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The bag breaks off: it was cut, or the recorder was killed.");
  EXPECT_NE(trackerBand(all, kNow).cure.find("rosbag reindex"), std::string::npos);
  EXPECT_EQ(trackerBand(all, kNow).detail, all.playback.reason);
  all.tracker.state = "TRACKING";
  all.tracker.result_at = kNow - 0.5;
  all.playback.reason = "bag 'a.bag' is damaged behind image 7 (Error); 'rosbag reindex' may repair it";
  EXPECT_EQ(trackerBand(all, kNow).sentence, "The bag is damaged here.");
}

// A tracker that was killed keeps its connection for roscpp, and its state was latched.
TEST(BandText, WhatIsSaidOfPicturesIsAsOldAsTheyAre) {
  Facts all = facts();
  all.tracker.result_at = kNow;
  for (const char* state : {"TRACKING", "SEARCHING", "LOST", "IDLE"}) {
    all.tracker.state = state;
    EXPECT_EQ(trackerBand(all, kNow + 0.2).word, state);
    const BandText stale = trackerBand(all, kNow + 0.3);
    EXPECT_EQ(stale.word, "NO RESULT") << "at once when the picture says NOT LIVE";
    EXPECT_EQ(stale.level, Level::kWaiting);
    EXPECT_EQ(stale.sentence, "No picture has been looked at for 0.3 s. Before: " + std::string(state) + ".");
    EXPECT_NE(stale.cure, "");
    EXPECT_EQ(trackerBand(all, kNow + 3.0).word, "SILENT");
  }
  all.tracker.state = "NO_IMAGE";
  EXPECT_EQ(trackerBand(all, kNow + 0.3).word, "NO IMAGE") << "the tracker says so itself";
  all.tracker.state = "NOT_STARTED";
  EXPECT_EQ(trackerBand(all, kNow + 0.3).word, "NOT STARTED");
  all.tracker.state = "TRACKING";
  all.playback.connected = true;
  all.playback.state = "PLAYING";
  all.playback.period = 0.2;
  EXPECT_EQ(trackerBand(all, kNow + 0.3).word, "TRACKING") << "a recording that plays slowly";
  EXPECT_EQ(trackerBand(all, kNow + 0.6).word, "NO RESULT");
  all.playback.state = "PAUSED";
  EXPECT_EQ(trackerBand(all, kNow + 0.6).word, "PAUSED");
  all.playback.connected = false;
  all.tracker.result_at = kNever;
  EXPECT_EQ(trackerBand(all, kNow + 0.6).word, "TRACKING") << "its results have not come yet";
}

TEST(BandText, ANodeThatIsSilentSaysForHowLong) {
  Facts all = facts();
  EXPECT_EQ(controllerBand(all, kNow + 0.3).word, "SERVO");
  EXPECT_EQ(controllerBand(all, kNow + 0.5).word, "SILENT");
  EXPECT_EQ(controllerBand(all, kNow + 0.5).sentence, "The controller has said nothing for 0.6 s.");
  EXPECT_EQ(robotBand(all, kNow + 0.3).word, "ENABLED");
  EXPECT_EQ(robotBand(all, kNow + 0.5).sentence, "The robot's node has said nothing for 0.6 s.");
}

TEST(BandText, SaysWhatIsNotThere) {
  Facts none;
  EXPECT_EQ(trackerBand(none, kNow).word, "NO MASTER");
  none.master = true;
  EXPECT_EQ(controllerBand(none, kNow).word, "ABSENT");
  none.robot.connected = true;
  EXPECT_EQ(robotBand(none, kNow).word, "WAITING");
  none.controller.connected = true;
  none.controller.heard_at = kNow;
  EXPECT_EQ(controllerBand(none, kNow).word, "WAITING") << "its state has not come yet";
}

TEST(BandText, AReasonThatNobodyKnowsIsShownAsItIs) {
  Facts all = facts();
  all.robot.state = "PAUSED";
  all.robot.reason = "<b>something</b> new";
  EXPECT_EQ(robotBand(all, kNow).sentence, "<b>something</b> new");
  EXPECT_NE(robotBand(all, kNow).cure.find("troubleshooting"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::screen
