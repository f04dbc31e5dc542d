// Asks one thing again and again, in threads of its own: while an answer is awaited, the newest question waits, and
// those between are dropped. One that hangs keeps nobody waiting but its like.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

namespace laparoscope_servo::screen {

class NewestCall {
 public:
  // Asks, and returns what is to be done with the answer.
  using Question = std::function<std::function<void()>()>;

  NewestCall() = default;
  // No answer is acted on any more; a call that hangs is left to itself.
  ~NewestCall();
  NewestCall(const NewestCall&) = delete;
  NewestCall& operator=(const NewestCall&) = delete;

  void ask(const Question& question);

 private:
  struct Shared {
    std::mutex mutex;
    bool runs = false;
    bool closed = false;
    Question waiting;
  };
  static void run(const std::shared_ptr<Shared>& shared, Question question);

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();  // with the threads
};

}  // namespace laparoscope_servo::screen
