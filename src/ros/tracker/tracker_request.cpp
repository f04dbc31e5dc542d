#include "ros/tracker/tracker_request.h"

#include <chrono>

namespace laparoscope_servo {

TrackerRequest::Answer TrackerRequest::ask(const Question& question, double timeout,
                                           const std::string& timeout_message) {
  const std::lock_guard<std::mutex> turn(turn_);
  std::unique_lock<std::mutex> lock(mutex_);
  waiting_ = question;
  answer_.reset();
  taken_ = false;
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  changed_.wait_until(lock, std::chrono::time_point_cast<std::chrono::steady_clock::duration>(until),
                      [this] { return taken_ || closed_; });
  // Once it is taken, the answer comes within milliseconds; a timeout now would report a failure of a request that is
  // being executed.
  if (taken_) changed_.wait(lock, [this] { return answer_.has_value() || closed_; });
  waiting_.reset();
  if (answer_) return *answer_;
  return {false, closed_ ? "the tracker is shutting down" : timeout_message, nullptr};
}

std::optional<TrackerRequest::Question> TrackerRequest::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!waiting_) return std::nullopt;
  const std::optional<Question> question = waiting_;
  waiting_.reset();
  taken_ = true;
  changed_.notify_all();
  return question;
}

void TrackerRequest::answer(const Answer& answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  answer_ = answer;
  changed_.notify_all();
}

void TrackerRequest::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace laparoscope_servo
