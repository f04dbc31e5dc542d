// Calls services, each call in its own thread, so that a hung one blocks no other. One call of each service at a time.
#pragma once

#include <ros/node_handle.h>
#include <ros/service.h>

#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

class ServiceCalls {
 public:
  using Told = std::function<void(const Answer&)>;

  // `told` is called from any thread, at the beginning and the end of a call.
  explicit ServiceCalls(const Told& told) : shared_(std::make_shared<Shared>()) { shared_->told = told; }
  // Later results are ignored; a hung call keeps its thread.
  ~ServiceCalls();
  ServiceCalls(const ServiceCalls&) = delete;
  ServiceCalls& operator=(const ServiceCalls&) = delete;

  // `service`: resolved name. `what`: name for texts. The response must have `success` and `message`. `then` is called
  // before `told` on success.
  template <class Service>
  void call(const std::string& service, const std::string& what, const Service& request,
            const std::function<void(const typename Service::Response&)>& then = nullptr) {
    start(service, what, [service, request, then](Answer& answer, std::function<void()>& act) {
      Service call = request;
      answer.success = ros::service::call(service, call) && call.response.success;
      if (answer.success && then) act = [then, response = call.response] { then(response); };
      answer.text = call.response.message;
      if (!answer.success && answer.text.empty()) answer.text = "no answer from " + service;
    });
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::set<std::string> waiting;
    Told told;
    void tell(const Answer& answer, const std::function<void()>& act = nullptr);
  };
  using Ask = std::function<void(Answer&, std::function<void()>&)>;
  void start(const std::string& service, const std::string& what, const Ask& ask);

  std::shared_ptr<Shared> shared_;  // shared with the threads
};

}  // namespace laparoscope_servo::screen
