// One pipe whose contents are carried to a file descriptor that may block. See UnblockedOutput.
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
  // Both descriptors are the channel's from now on. Its two threads end with the process, so it must never be deleted.
  OutputChannel(int pipe, int target);

  // Nothing is on its way. Only atomics and a system call: a signal handler may ask.
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
  std::uint64_t unsaid_ = 0;               // lines dropped, and not said yet
  std::atomic<bool> collecting_{false};    // between the pipe and pending_
  std::atomic<std::int64_t> pending_{0};   // bytes taken out of the pipe and not yet written
  std::atomic<std::uint64_t> dropped_{0};  // lines
};

}  // namespace laparoscope_servo
