// Passes a request from the thread of the services to that of the images, and the answer back.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "laparoscope_servo/geometry/homography.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

class TrackerRequest {
 public:
  struct WantSnapshot {};  // requests a snapshot of the next image
  // A ROI to select in the next image, a snapshot, or a way to follow from the next image on.
  using Question = std::variant<geometry::Rectangle, WantSnapshot, RecallRoute>;

  struct Answer {
    bool success = false;
    std::string message;
    std::shared_ptr<const Snapshot> snapshot = nullptr;  // to WantSnapshot
  };

  // For services: waits until the image thread has answered. If that does not take the request within `timeout` s
  // (steady clock), the answer is `timeout_message`. One request at a time; others wait.
  Answer ask(const Question& question, double timeout, const std::string& timeout_message);

  // For images: takes the waiting request, if there is one; it must be answered.
  std::optional<Question> take();
  void answer(const Answer& answer);

  // Ends all waiting, now and later, e.g. when the node shuts down.
  void close();

 private:
  std::mutex turn_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Question> waiting_;
  std::optional<Answer> answer_;
  bool taken_ = false;
  bool closed_ = false;
};

}  // namespace laparoscope_servo
