#include "screen/service_calls.h"

#include <exception>

namespace laparoscope_servo::screen {

// An answer that is being told meanwhile may start another call: it gets no line any more. Each line waits at its end
// for the answer that it is telling.
ServiceCalls::~ServiceCalls() {
  std::map<std::string, std::shared_ptr<NewestCall>> ended;
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  ended.swap(lines_);
}

std::shared_ptr<NewestCall> ServiceCalls::lineOf(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_) return nullptr;
  std::shared_ptr<NewestCall>& line = lines_[name];
  if (!line) line = std::make_shared<NewestCall>();
  return line;
}

void ServiceCalls::unanswered(const std::string& service, Answer& answer) {
  answer.outcome = Outcome::kUnanswered;
  answer.text = ros::service::exists(service, false) ? "No answer came from " + service + "."
                                                     : "No node offers " + service + ": it is not running.";
}

Answer ServiceCalls::askSafely(const std::string& what, const Ask& ask, std::function<void()>& act) {
  Answer answer{what, "", Outcome::kUnanswered};
  try {
    ask(answer, act);
  } catch (const std::exception& error) {
    answer = {what, error.what(), Outcome::kUnanswered};
  }
  return answer;
}

void ServiceCalls::start(const std::string& service, const std::string& what, const Ask& ask, const Manner& manner) {
  const std::shared_ptr<NewestCall> line = lineOf(manner.line.empty() ? service : manner.line);
  if (!line) return;
  const Told told = manner.told ? manner.told : told_;
  const auto is_wanted = [wanted = manner.wanted] { return !wanted || wanted(); };
  told({what, "", Outcome::kWaiting});
  const bool asks = line->ask([what, ask, told, is_wanted, late = manner.late]() -> std::function<void()> {
    if (!is_wanted()) return nullptr;
    std::function<void()> act;
    const Answer answer = askSafely(what, ask, act);
    return [answer, act, told, is_wanted, late] {
      if (is_wanted()) {
        if (act) act();
        told(answer);
      } else if (late && answer.outcome == Outcome::kDone) {
        late();
      }
    };
  });
  if (!asks) told({what, "No thread is available.", Outcome::kUnanswered});
}

}  // namespace laparoscope_servo::screen
