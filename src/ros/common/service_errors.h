// What services throw. roscpp would only log it, and the node would go on as if nothing had happened: it is kept for
// the loop, which ends the node with it.
#pragma once

#include <exception>

namespace laparoscope_servo {

class ServiceErrors {
 public:
  // Calls `serve`. What it throws is kept, the first of several, and is the service's answer: no success, and its
  // words.
  template <class Response, class Serve>
  void guard(Response& response, const Serve& serve) {
    try {
      serve();
    } catch (const std::exception& error) {
      if (!first_) first_ = std::current_exception();
      response.success = 0;
      response.message = error.what();
    }
  }

  // Throws what was kept, if anything was.
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

}  // namespace laparoscope_servo
