#include "laparoscope_servo/features/feature_state.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::features {

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
  return "";
}

const char* reasonText(Reason reason) {
  switch (reason) {
    case Reason::kNone:
      return "";
    case Reason::kNothingSelected:
      return "nothing is selected";
    case Reason::kReset:
      return "reset";
    case Reason::kTimeJumpedBack:
      return "the stamp lies before the last one";
    case Reason::kImageChanged:
      return "the image has another size or type than the one of the selection";
    case Reason::kOutside:
      return "outside the image";
    case Reason::kTooFewSites:
      return "covered: too little of it shows the edge that was selected";
    case Reason::kChance:
      return "what agrees may agree by chance";
    case Reason::kUndetermined:
      return "what is seen does not determine it";
    case Reason::kUncertain:
      return "the expected error is too large";
    case Reason::kJump:
      return "it would have jumped to something that looks different";
    case Reason::kShape:
      return "it would have changed its size or shape too fast";
    case Reason::kNotConfirmed:
      return "found again, to be confirmed by the next images";
    case Reason::kTaken:
      return "another feature was found in its place";
    case Reason::kNotSeen:
      return "nothing near there looks like it: covered, gone, or merged with something";
    case Reason::kAmbiguous:
      return "the image shows it in two poses that cannot be told apart";
    case Reason::kCovered:
      return "covered: too little of it looks as it did when it was selected";
    case Reason::kFirstImage:
      return "motion is told from the second image on";
    case Reason::kNothingUsable:
      return "nearly all of it is highlight, dark, or masked";
    case Reason::kNoTexture:
      return "too little texture to tell how it moves";
    case Reason::kNothingDominates:
      return "no motion dominates: too little of the texture moves as one";
  }
  return "";
}

void describe(parameters::Table& table, StateConfig& c) {
  table.number("max_search_time", c.max_search_time, {0, 600}, "s", "SEARCHING for longer is LOST");
  table.number("confirmations", c.confirmations, {1, 100}, "images",
               "in a row that show the feature, before TRACKING is said again");
}

void StateKeeper::select(double stamp) {
  state_ = State::kTracking;
  reason_ = Reason::kNone;
  confirmed_ = 0;
  since_ = stamp;
}

void StateKeeper::reset(Reason reason) {
  state_ = State::kIdle;
  reason_ = reason;
  confirmed_ = 0;
}

void StateKeeper::step(Reason reason, double stamp) {
  if (state_ == State::kIdle) return;
  reason_ = reason;
  if (reason == Reason::kNone) {
    if (state_ == State::kTracking) return;
    if (++confirmed_ >= config_.confirmations) {
      select(stamp);
      return;
    }
    reason_ = Reason::kNotConfirmed;
  } else {
    confirmed_ = 0;
    if (state_ == State::kTracking) {
      state_ = State::kSearching;
      since_ = stamp;
    }
  }
  if (!(stamp - since_ <= config_.max_search_time)) state_ = State::kLost;
}

}  // namespace laparoscope_servo::features
