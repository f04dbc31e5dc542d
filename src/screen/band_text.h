// What the three bands say: of tracker, controller and robot, by the facts and the table of reasons.
#pragma once

#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

enum class Level {
  kUnknown,  // nobody says anything
  kResting,  // as it should be, and nothing moves by it
  kGood,     // tracks, moves, may move
  kWaiting,  // something is missing for now
  kBad,      // somebody has to do something
};

struct BandText {
  std::string word;      // a few letters that one reads from afar
  std::string sentence;  // why
  std::string cure;      // what to do; empty: nothing
  std::string detail;    // the node's own words
  Level level = Level::kUnknown;
};

BandText trackerBand(const Facts& facts, double now);
BandText controllerBand(const Facts& facts, double now);
BandText robotBand(const Facts& facts, double now);

}  // namespace laparoscope_servo::screen
