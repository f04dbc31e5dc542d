#include "ros/playback/playback_control.h"

#include <cmath>

namespace laparoscope_servo {

std::string PlaybackControl::command(const std::string& command, double position) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (state_ == State::kWaiting) return "the recording has not begun: it waits for who is to see it";
  const bool ended = state_ == State::kEnded || state_ == State::kFailed;
  if (command == "SEEK" || command == "AGAIN") {
    const double to = command == "AGAIN" ? 0.0 : position;
    if (!(to >= 0.0 && std::isfinite(to))) return "position is " + std::to_string(position) + " s, expected 0 or more";
    seek_ = to;
    steps_ = 0;
    if (command == "AGAIN") {
      state_ = State::kPlaying;
    } else if (state_ != State::kPlaying) {  // plays one image, to be shown
      state_ = State::kPaused;
      steps_ = 1;
    }
    return "";
  }
  if (command != "PLAY" && command != "PAUSE" && command != "STEP")
    return "command is '" + command + "', expected PLAY, PAUSE, STEP, SEEK or AGAIN";
  if (state_ == State::kFailed) return "the recording cannot be read: AGAIN tries once more";
  if (ended) return "the recording has ended: AGAIN, or SEEK";
  state_ = command == "PLAY" ? State::kPlaying : State::kPaused;
  if (command == "STEP") ++steps_;
  return "";
}

void PlaybackControl::begin(bool hold) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (begun_) return;
  begun_ = true;
  state_ = hold ? State::kHolding : State::kPlaying;
  steps_ = hold ? 1 : 0;  // plays the image at which it holds
}

bool PlaybackControl::hasBegun() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return begun_;
}

void PlaybackControl::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!seek_) state_ = State::kEnded;
  steps_ = 0;
}

void PlaybackControl::fail() {
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = State::kFailed;
  seek_.reset();
  steps_ = 0;
}

void PlaybackControl::releaseHold() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (state_ == State::kHolding) state_ = State::kPlaying;
}

std::optional<double> PlaybackControl::takeSeek() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::optional<double> seek = seek_;
  seek_.reset();
  return seek;
}

bool PlaybackControl::takeImage() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (seek_ || state_ == State::kEnded || state_ == State::kFailed || state_ == State::kWaiting) return false;
  if (state_ == State::kPlaying) return true;
  if (steps_ == 0) return false;
  --steps_;
  return true;
}

PlaybackControl::State PlaybackControl::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

const char* PlaybackControl::stateName() const {
  switch (state()) {
    case State::kWaiting:
      return "WAITING";
    case State::kHolding:
      return "HOLDING";
    case State::kPlaying:
      return "PLAYING";
    case State::kPaused:
      return "PAUSED";
    case State::kFailed:
      return "FAILED";
    case State::kEnded:
      break;
  }
  return "ENDED";
}

}  // namespace laparoscope_servo
