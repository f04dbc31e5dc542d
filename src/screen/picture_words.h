// Whether the picture shows what is now, and the words that say so when it does not.
#pragma once

#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

constexpr double kOldest = 0.25;  // s: what is older is no live picture. The controller holds then, too

struct PictureWords {
  bool live = false;
  std::string words;   // large; empty while live
  std::string detail;  // below them
};

// `playback`: the state of the player of a recording; empty: there is none.
PictureWords pictureWords(const Picture& picture, double now, const std::string& playback = "");

}  // namespace laparoscope_servo::screen
