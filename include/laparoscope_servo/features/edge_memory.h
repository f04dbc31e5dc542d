// What the edge of a curve looked like, slot by slot, in the images that showed it.
#pragma once

#include <cstddef>
#include <vector>

#include "laparoscope_servo/features/edge_search.h"

namespace laparoscope_servo::features {

// Which edges may be the curve's.
enum class EdgeSign {
  kRemembered,  // those that look like what is remembered of the slot
  kPositive,    // nothing is remembered yet: any that is brighter where the normal points to
  kNegative,
  kAny,
};

class EdgeMemory {
 public:
  // Forgets everything; for a curve of so many slots, each of which looks like those up to `like` further on.
  void reset(int slots, int like);
  // Adds the share `share` (0 to 1) of `now` to what is remembered of the slot; all of it where nothing is.
  void learn(int slot, const EdgeLooks& now, float share);
  // Of the slot itself, else of the nearest one that is known and looks alike; null while none is.
  const EdgeLooks* find(int slot) const;

 private:
  struct Entry {
    EdgeLooks looks;
    bool known = false;
  };

  std::vector<Entry> entries_;
  int like_ = 0;  // slots
};

// Looks of edges, pair by pair and all together, against those remembered; the means tell smaller differences.
class LooksComparison {
 public:
  void add(const EdgeLooks& now, const EdgeLooks& before);
  // `used`: number of edges that the curve was fitted to. A gain of the light is borne; contrast and both sides have to
  // follow it alike.
  bool isAlike(int used) const;

 private:
  static void sum(const EdgeLooks& looks, EdgeLooks& total);

  EdgeLooks now_, before_;  // sums
  int alike_ = 0;
};

}  // namespace laparoscope_servo::features
