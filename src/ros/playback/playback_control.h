// Whether a recording goes on, and where: what somebody wants, from any thread, for the thread that plays. No ROS here.
#pragma once

#include <mutex>
#include <optional>
#include <string>

namespace laparoscope_servo {

class PlaybackControl {
 public:
  enum class State { kWaiting, kHolding, kPlaying, kPaused, kEnded };

  // Any thread. Commands are those of ControlPlayback.srv. Returns why it is not done; empty: it is.
  std::string command(const std::string& command, double position);

  // The player's. begin(): after those who are waited for have come.
  void begin(bool hold);
  void end();
  // A region was selected.
  void releaseHold();
  // Where to go on from, once [s]; 0 is the beginning.
  std::optional<double> takeSeek();
  // Whether the next image is to be played; takes a step that was asked for.
  bool takeImage();

  State state() const;
  const char* stateName() const;

 private:
  mutable std::mutex mutex_;
  State state_ = State::kWaiting;
  int steps_ = 0;
  std::optional<double> seek_;
};

}  // namespace laparoscope_servo
