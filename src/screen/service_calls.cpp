#include "screen/service_calls.h"

#include <exception>
#include <thread>
#include <utility>

namespace laparoscope_servo::screen {

ServiceCalls::~ServiceCalls() {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  shared_->told = nullptr;
}

void ServiceCalls::Shared::tell(const Told& who, const Answer& answer) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (told) (who ? who : told)(answer);
}

void ServiceCalls::Shared::end(const std::string& service, const Answer& answer, const std::function<void()>& act) {
  const std::lock_guard<std::mutex> lock(mutex);
  const std::vector<Told> all = std::move(waiting[service]);
  waiting.erase(service);
  if (!told) return;
  if (act) act();
  for (const Told& who : all) (who ? who : told)(answer);
}

void ServiceCalls::unanswered(const std::string& service, Answer& answer) {
  answer.outcome = Outcome::kUnanswered;
  answer.text = ros::service::exists(service, false) ? "No answer came from " + service + "."
                                                     : "No node offers " + service + ": it is not running.";
}

void ServiceCalls::start(const std::string& service, const std::string& what, const Ask& ask, const Told& told) {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    const auto [call, is_new] = shared_->waiting.try_emplace(service);
    if (is_new || told) call->second.push_back(told);
    if (!is_new) return;
  }
  shared_->tell(told, {what, "", Outcome::kWaiting});
  try {
    std::thread([shared = shared_, service, what, ask] {
      Answer answer{what, "", Outcome::kUnanswered};
      std::function<void()> act;
      try {
        ask(answer, act);
      } catch (const std::exception& error) {
        answer = {what, error.what(), Outcome::kUnanswered};
      }
      shared->end(service, answer, act);
    }).detach();
  } catch (const std::exception& error) {  // no thread is available
    shared_->end(service, {what, error.what(), Outcome::kUnanswered}, nullptr);
  }
}

}  // namespace laparoscope_servo::screen
