#include "screen/newest_call.h"

#include <exception>
#include <thread>

namespace laparoscope_servo::screen {

NewestCall::~NewestCall() {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  shared_->closed = true;
  shared_->waiting = nullptr;
}

bool NewestCall::ask(const Question& question) {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  if (shared_->runs) {
    shared_->waiting = question;
    return true;
  }
  try {
    std::thread([shared = shared_, question] { run(shared, question); }).detach();
    shared_->runs = true;
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

void NewestCall::run(const std::shared_ptr<Shared>& shared, Question question) {
  while (question) {
    std::function<void()> act;
    try {
      act = question();
    } catch (const std::exception&) {  // no answer
    }
    const std::lock_guard<std::mutex> lock(shared->mutex);
    if (act && !shared->closed) act();
    question = std::move(shared->waiting);
    shared->waiting = nullptr;
    if (!question) shared->runs = false;
  }
}

}  // namespace laparoscope_servo::screen
