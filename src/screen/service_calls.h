// Calls services in separate threads, so that a hung one blocks no other. While a call is unanswered, only the newest
// one of its line waits.
#pragma once

#include <ros/node_handle.h>
#include <ros/service.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "screen/facts.h"
#include "screen/newest_call.h"
#include "screen/wish.h"

namespace laparoscope_servo::screen {

class ServiceCalls {
 public:
  using Told = std::function<void(const Answer&)>;

  struct Manner {
    // Takes the results instead of the constructor's.
    Told told = nullptr;
    // An unwanted call is not sent any more. If it has been sent already, its answer is dropped; null: always wanted.
    Wish::Holds wanted = nullptr;
    // Called instead when the node has done what the unwanted call asked for.
    std::function<void()> late = nullptr;
    // Calls with the same line are sent in order; empty: the service.
    std::string line = "";
  };

  // `told` is called from any thread, at the beginning and the end of a call.
  explicit ServiceCalls(const Told& told) : told_(told) {}
  // Later results are ignored; a hung call keeps its thread.
  ~ServiceCalls();
  ServiceCalls(const ServiceCalls&) = delete;
  ServiceCalls& operator=(const ServiceCalls&) = delete;

  // `service`: resolved name. `what`: name for texts. The response must have `success` and `message`. `then` is called
  // before `told` on success.
  template <class Service>
  void call(const std::string& service, const std::string& what, const Service& request, const Manner& manner = {},
            const std::function<void(const typename Service::Response&)>& then = nullptr) {
    const Ask ask = [service, request, then](Answer& answer, std::function<void()>& act) {
      Service call = request;
      if (!ros::service::call(service, call)) return unanswered(service, answer);
      answer.outcome = call.response.success ? Outcome::kDone : Outcome::kRefused;
      answer.text = call.response.message;
      if (answer.outcome == Outcome::kDone && then) act = [then, response = call.response] { then(response); };
    };
    start(service, what, ask, manner);
  }

 private:
  using Ask = std::function<void(Answer&, std::function<void()>&)>;
  static void unanswered(const std::string& service, Answer& answer);
  static Answer askSafely(const std::string& what, const Ask& ask, std::function<void()>& act);
  void start(const std::string& service, const std::string& what, const Ask& ask, const Manner& manner);
  std::shared_ptr<NewestCall> lineOf(const std::string& name);  // null: the destructor has begun

  Told told_;
  std::mutex mutex_;  // guards what follows; not held while anyone is told
  bool closed_ = false;
  std::map<std::string, std::shared_ptr<NewestCall>> lines_;
};

}  // namespace laparoscope_servo::screen
