// Decides whether the picture is live, and makes the text if it is not.
#pragma once

#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

constexpr double kOldest = 0.25;  // s: an older picture is not live. The controller is in HOLD then too

struct PictureWords {
  bool live = false;
  std::string words;   // large; empty while live
  std::string detail;  // below them
};

// s, above which a picture, or what is said of one, is not live. A recording that plays slowly has older ones.
double oldestLive(const PlaybackFacts& playback);

// `playback`: a recording that plays slowly has older pictures that are live.
PictureWords pictureWords(const Picture& picture, double now, const PlaybackFacts& playback = {});

}  // namespace laparoscope_servo::screen
