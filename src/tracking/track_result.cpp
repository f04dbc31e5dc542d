#include "laparoscope_servo/tracking/track_result.h"

namespace laparoscope_servo::tracking {

const char* stateName(State state) {
  switch (state) {
    case State::kIdle:
      return "IDLE";
    case State::kTracking:
      return "TRACKING";
    case State::kSearching:
      return "SEARCHING";
    case State::kLost:
      return "LOST";
  }
  return "unknown";
}

}  // namespace laparoscope_servo::tracking
