#include "screen/picture_words.h"

#include <algorithm>
#include <cstdio>

namespace laparoscope_servo::screen {

namespace {

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), value < 9.95 ? "%.1f s" : "%.0f s", std::min(value, 1e6));
  return text;
}

}  // namespace

PictureWords pictureWords(const Picture& picture, double now, const std::string& playback) {
  if (picture.image.isNull() || picture.arrived_at < 0.0)
    return {false, "NO PICTURE", "The tracker has sent none yet."};
  if (playback == "ENDED") return {false, "ENDED", "This is its last picture. \"Again\" plays it once more."};
  // The player is paused on purpose, which the bar below shows.
  if (playback == "HOLDING" || playback == "PAUSED") return {true, "", ""};
  const double age = now - picture.arrived_at + std::max(0.0, picture.age_at_arrival);
  if (!(age <= kOldest)) return {false, "NOT LIVE", "This picture is " + seconds(age) + " old."};
  const double still = picture.arrived_at - picture.changed_at;
  if (!(still <= kOldest)) return {false, "STANDS STILL", "The same picture comes again for " + seconds(still) + "."};
  return {true, "", ""};
}

}  // namespace laparoscope_servo::screen
