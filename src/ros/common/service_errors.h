// Keeps exceptions of services for the node's loop, which ends the node with them. roscpp would only log them, and the
// node would go on.
#pragma once

#include <exception>

namespace laparoscope_servo {

class ServiceErrors {
 public:
  // Calls `serve`. Keeps its exception (the first of several) and answers the service with success false and its text.
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

  // Throws the kept exception, if there is one.
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

}  // namespace laparoscope_servo
