#include "screen/service_calls.h"

#include <exception>
#include <thread>

namespace laparoscope_servo::screen {

ServiceCalls::~ServiceCalls() {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  shared_->told = nullptr;
}

void ServiceCalls::Shared::tell(const Answer& answer, const std::function<void()>& act) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (!told) return;
  if (act) act();
  told(answer);
}

void ServiceCalls::start(const std::string& service, const std::string& what, const Ask& ask) {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    if (!shared_->waiting.insert(service).second) return;  // a call of this service is under way already
  }
  shared_->tell({what, "", false, true});
  try {
    std::thread([shared = shared_, service, what, ask] {
      Answer answer{what, "", false, false};
      std::function<void()> act;
      try {
        ask(answer, act);
      } catch (const std::exception& error) {
        answer = {what, error.what(), false, false};
      }
      {
        const std::lock_guard<std::mutex> lock(shared->mutex);
        shared->waiting.erase(service);
      }
      shared->tell(answer, act);
    }).detach();
  } catch (const std::exception& error) {  // no thread is available
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->waiting.erase(service);
  }
}

}  // namespace laparoscope_servo::screen
