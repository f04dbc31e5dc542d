// Calls services, each call in its own thread, so that a hung one blocks no other. One call of each service at a time.
#pragma once

#include <ros/node_handle.h>
#include <ros/service.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

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
    start(service, what, asking(service, request, then), nullptr);
  }
  // As above, with the results to `told` alone, also those of a call of this service that is under way already.
  template <class Service>
  void call(const std::string& service, const std::string& what, const Service& request, const Told& told) {
    start(service, what, asking<Service>(service, request, nullptr), told);
  }

 private:
  using Ask = std::function<void(Answer&, std::function<void()>&)>;
  struct Shared {
    std::mutex mutex;
    std::map<std::string, std::vector<Told>> waiting;  // of each call under way: who is told; null: the constructor's
    Told told;
    void tell(const Told& who, const Answer& answer);
    void end(const std::string& service, const Answer& answer, const std::function<void()>& act);
  };
  template <class Service>
  static Ask asking(const std::string& service, const Service& request,
                    const std::function<void(const typename Service::Response&)>& then) {
    return [service, request, then](Answer& answer, std::function<void()>& act) {
      Service call = request;
      if (!ros::service::call(service, call)) return unanswered(service, answer);
      answer.outcome = call.response.success ? Outcome::kDone : Outcome::kRefused;
      answer.text = call.response.message;
      if (answer.outcome == Outcome::kDone && then) act = [then, response = call.response] { then(response); };
    };
  }
  static void unanswered(const std::string& service, Answer& answer);
  void start(const std::string& service, const std::string& what, const Ask& ask, const Told& told);

  std::shared_ptr<Shared> shared_;  // shared with the threads
};

}  // namespace laparoscope_servo::screen
