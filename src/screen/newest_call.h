// Repeats a call in separate threads: while one is unanswered, only the newest question waits, and those between are
// dropped. A hung call blocks only calls of the same kind.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

namespace laparoscope_servo::screen {

class NewestCall {
 public:
  // Does the call, and returns the action for its answer, which must not ask here again.
  using Question = std::function<std::function<void()>()>;

  NewestCall() = default;
  // Later answers are ignored; a hung call keeps its thread.
  ~NewestCall();
  NewestCall(const NewestCall&) = delete;
  NewestCall& operator=(const NewestCall&) = delete;

  // Returns false if no thread is available.
  bool ask(const Question& question);

 private:
  struct Shared {
    std::mutex mutex;
    bool runs = false;
    bool closed = false;
    Question waiting;
  };
  static void run(const std::shared_ptr<Shared>& shared, Question question);

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();  // shared with the threads
};

}  // namespace laparoscope_servo::screen
