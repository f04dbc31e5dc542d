// Hands a request for a ROI from the thread of a service to the thread of the images, and the answer back.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::skin {

class RoiRequest {
 public:
  struct Answer {
    bool success = false;
    std::string message;
  };

  // Service: waits until the image thread has answered, at most `timeout` s (steady clock) until it takes the request;
  // without an answer `timeout_message` says so. One at a time: others wait for their turn.
  Answer ask(const geometry::Rectangle& roi, double timeout, const std::string& timeout_message);

  // Images: the request, if one waits; whoever takes it has to answer.
  std::optional<geometry::Rectangle> take();
  void answer(const Answer& answer);

  // Ends all waiting, now and later, e.g. because the node shuts down.
  void close();

 private:
  std::mutex turn_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<geometry::Rectangle> waiting_;
  std::optional<Answer> answer_;
  bool taken_ = false;
  bool closed_ = false;
};

}  // namespace laparoscope_servo::skin
