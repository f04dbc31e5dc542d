// Copies the contents of a pipe to a file descriptor that may block. See UnblockedOutput.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace laparoscope_servo {

class OutputChannel {
 public:
  // Takes over both descriptors. Its two threads end with the process, so it must never be deleted.
  OutputChannel(int pipe, int target);

  // Whether no text is under way. Uses only atomics and a system call, so that signal handlers may call it.
  bool isEmpty() const;
  std::uint64_t dropped() const { return dropped_; }

 private:
  void collect();
  void push(std::string text);
  void deliver();
  void write(const std::string& text);

  const int pipe_;
  const int target_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<std::string> queue_;
  std::size_t queued_ = 0;                 // bytes
  std::uint64_t unsaid_ = 0;               // dropped lines that are not reported yet
  std::atomic<bool> collecting_{false};    // bytes were taken from the pipe and are not in pending_ yet
  std::atomic<std::int64_t> pending_{0};   // bytes taken out of the pipe and not yet written
  std::atomic<std::uint64_t> dropped_{0};  // dropped lines
};

}  // namespace laparoscope_servo
