// Commands of playback (play, pause, step, seek), from any thread to the thread that plays. Has no ROS.
#pragma once

#include <mutex>
#include <optional>
#include <string>

namespace laparoscope_servo {

class PlaybackControl {
 public:
  enum class State { kWaiting, kHolding, kPlaying, kPaused, kEnded, kFailed };

  // May be called from any thread. Commands are those of ControlPlayback.srv. Returns why it is refused, or an empty
  // text.
  std::string command(const std::string& command, double position);

  // The functions below are for the player. begin(): call when the awaited subscribers are there.
  void begin(bool hold);  // no effect the second time
  bool hasBegun() const;
  void end();
  void fail();  // the recording cannot be read, or not further
  // A region was selected.
  void releaseHold();
  // Takes a requested position [s]; 0 is the beginning.
  std::optional<double> takeSeek();
  // Whether to play the next image; takes a requested step.
  bool takeImage();

  State state() const;
  const char* stateName() const;

 private:
  mutable std::mutex mutex_;
  State state_ = State::kWaiting;
  bool begun_ = false;
  int steps_ = 0;
  std::optional<double> seek_;
};

}  // namespace laparoscope_servo
