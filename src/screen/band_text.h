// Texts of the three bands of tracker, controller and robot, and of the line of each tracker of features, from the
// facts and the table of reasons.
#pragma once

#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

enum class Level {
  kUnknown,  // no messages
  kResting,  // normal, without motion
  kGood,     // tracking, moving, or ready to move
  kWaiting,  // something is missing at present
  kBad,      // an operator must act
};

struct BandText {
  std::string word;      // a short word, readable from afar
  std::string sentence;  // why
  std::string cure;      // what to do; empty: nothing
  std::string detail;    // the node's own text
  Level level = Level::kUnknown;
  std::string note = {};  // beside the name of the node

  bool operator==(const BandText& other) const {
    return word == other.word && sentence == other.sentence && cure == other.cure && detail == other.detail &&
           level == other.level && note == other.note;
  }
};

BandText trackerBand(const Facts& facts, double now);
BandText controllerBand(const Facts& facts, double now);
// Whether what the controller said last is still true.
bool controllerSpeaks(const Facts& facts, double now);
BandText robotBand(const Facts& facts, double now);
BandText featureBand(const Facts& facts, const FeatureTrackerFacts& tracker, double now);

}  // namespace laparoscope_servo::screen
