#include "ros/playback/pending_pictures.h"

#include <algorithm>

namespace laparoscope_servo {

namespace {

constexpr std::int64_t kMostReordered = 64;  // pictures; codecs reorder at most 16

using Sent = PendingPictures::Sent;

void sort(std::vector<Sent>& pictures) {
  std::stable_sort(pictures.begin(), pictures.end(), [](const Sent& a, const Sent& b) { return a.time < b.time; });
}

}  // namespace

std::vector<Sent> PendingPictures::came(std::int64_t index, Time time) {
  waiting_.erase(index);
  std::vector<Sent> lost;
  // Only pictures sent before it: after a place where two recordings were joined, times may be smaller.
  for (auto it = waiting_.begin(); it != waiting_.end() && it->first < index;) {
    const bool earlier = it->second.time && time && *it->second.time < *time;
    if (earlier || it->first < index - kMostReordered) {
      lost.push_back(it->second);
      it = waiting_.erase(it);
    } else {
      ++it;
    }
  }
  sort(lost);
  return lost;
}

std::vector<Sent> PendingPictures::end() {
  std::vector<Sent> lost;
  for (const auto& [index, picture] : waiting_) lost.push_back(picture);
  waiting_.clear();
  sort(lost);
  return lost;
}

}  // namespace laparoscope_servo
