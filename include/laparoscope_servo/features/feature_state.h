// What may be believed of a tracked feature, and why not more. Shared by all trackers of features.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::features {

// TRACKING: this image showed the feature where the result says. SEARCHING: it did not, the result is where the feature
// is expected. LOST: SEARCHING for longer than max_search_time; the search goes on. IDLE: nothing is selected.
enum class State { kIdle = 0, kTracking = 1, kSearching = 2, kLost = 3 };

enum class Reason {
  kNone,
  kNothingSelected,
  kReset,
  kTimeJumpedBack,
  kImageChanged,
  kOutside,
  kTooFewSites,
  kChance,
  kUndetermined,
  kUncertain,
  kJump,
  kShape,
  kNotConfirmed,
  kTaken,
  kNotSeen,
  kAmbiguous,
  kCovered,
  kFirstImage,
  kNothingUsable,
  kNoTexture,
  kNothingDominates,
};

const char* stateName(State state);
// A sentence without a full stop; empty for kNone.
const char* reasonText(Reason reason);

struct StateConfig {
  double max_search_time = 2.0;  // s: SEARCHING for longer is LOST
  int confirmations = 3;         // images in a row that show the feature, before TRACKING is said again
};
// Its rows in the table of the tracker that has it.
void describe(parameters::Table& table, StateConfig& config);

// The states and what leads from one to the other. No clock: stamps are those of the images, s.
class StateKeeper {
 public:
  explicit StateKeeper(const StateConfig& config) : config_(config) {}

  void select(double stamp);
  void reset(Reason reason);
  // After an image: kNone when it showed the feature, else why not.
  void step(Reason reason, double stamp);

  State state() const { return state_; }
  Reason reason() const { return reason_; }
  // Images in a row that have shown the feature since it was lost.
  int confirmed() const { return confirmed_; }
  double searchingSince() const { return since_; }

 private:
  StateConfig config_;
  State state_ = State::kIdle;
  Reason reason_ = Reason::kNothingSelected;
  int confirmed_ = 0;
  double since_ = 0.0;
};

}  // namespace laparoscope_servo::features
