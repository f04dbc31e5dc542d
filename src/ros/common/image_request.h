// Passes a request from the thread of the services to that of the images, and the answer back.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace laparoscope_servo {

// `AnswerType` begins with bool success and std::string message.
template <class QuestionType, class AnswerType>
class ImageRequest {
 public:
  using Question = QuestionType;
  using Answer = AnswerType;

  // For services: waits until the image thread has answered. If that does not take the request within `timeout` s
  // (steady clock), the answer is `timeout_message`. One request at a time; others wait.
  Answer ask(const Question& question, double timeout, const std::string& timeout_message) {
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
    Answer answer;
    answer.message = closed_ ? "the tracker is shutting down" : timeout_message;
    return answer;
  }

  // For images: takes the waiting request, if there is one; it must be answered.
  std::optional<Question> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::optional<Question> question = std::exchange(waiting_, std::nullopt);
    if (question) {
      taken_ = true;
      changed_.notify_all();
    }
    return question;
  }

  void answer(const Answer& answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    answer_ = answer;
    changed_.notify_all();
  }

  // Ends all waiting, now and later, e.g. when the node shuts down.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex turn_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Question> waiting_;
  std::optional<Answer> answer_;
  bool taken_ = false;
  bool closed_ = false;
};

// Takes a waiting request, and answers it also if an exception is thrown.
template <class Request>
class AnswerGuard {
 public:
  explicit AnswerGuard(Request& request) : request_(request), question_(request.take()) {
    answer_.message = "the image could not be processed";
  }
  ~AnswerGuard() {
    if (question_) request_.answer(answer_);
  }
  AnswerGuard(const AnswerGuard&) = delete;
  AnswerGuard& operator=(const AnswerGuard&) = delete;

  const std::optional<typename Request::Question>& question() const { return question_; }
  void set(const typename Request::Answer& answer) { answer_ = answer; }

 private:
  Request& request_;
  std::optional<typename Request::Question> question_;
  typename Request::Answer answer_;
};

}  // namespace laparoscope_servo
