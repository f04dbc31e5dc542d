#include "screen/picture_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ros/reasons/reason_table.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kPatience = 2.5;  // periods of a recording: one picture may be late, or repeat

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), value < 9.95 ? "%.1f s" : "%.0f s", std::min(value, 1e6));
  return text;
}

}  // namespace

double oldestLive(const PlaybackFacts& playback) {
  const bool slow = playback.connected && std::isfinite(playback.period);
  return slow ? std::max(kOldest, kPatience * playback.period) : kOldest;
}

PictureWords pictureWords(const Picture& picture, double now, const PlaybackFacts& playback) {
  if (playback.connected && playback.state == "FAILED") {
    const ReasonRow* row = explain(Speaker::kPlayer, playback.reason);
    return {false, "UNREADABLE", row != nullptr ? row->sentence : playback.reason};
  }
  if (picture.image.isNull() || picture.arrived_at < 0.0)
    return {false, "NO PICTURE", "The tracker has sent none yet."};
  const std::string state = playback.connected ? playback.state : "";
  if (state == "ENDED") return {false, "ENDED", "This is its last picture. \"Again\" plays it once more."};
  // The player is paused on purpose, which the bar below shows.
  if (state == "HOLDING" || state == "PAUSED") return {true, "", ""};
  const double age = now - picture.arrived_at + std::max(0.0, picture.age_at_arrival);
  const double oldest = oldestLive(playback);
  if (!(age <= oldest)) return {false, "NOT LIVE", "This picture is " + seconds(age) + " old."};
  const double still = picture.arrived_at - picture.changed_at;
  if (!(still <= oldest)) return {false, "STANDS STILL", "The same picture comes again for " + seconds(still) + "."};
  return {true, "", ""};
}

}  // namespace laparoscope_servo::screen
