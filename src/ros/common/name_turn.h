// One nodelet of a name at a time in a process.
//
// A nodelet manager that unloads a nodelet does not wait for a callback that runs: the nodelet lives until that ends,
// on a thread of the manager. Until then its services stay advertised, and roscpp gives none of that name to the next
// one.
#pragma once

#include <string>

namespace laparoscope_servo {

class NameTurn {
 public:
  NameTurn() = default;
  // Gives the name back. The services of the nodelet must have ended: declare it before them.
  ~NameTurn();
  NameTurn(const NameTurn&) = delete;
  NameTurn& operator=(const NameTurn&) = delete;

  // Waits at most `timeout` s (steady clock) until nobody in this process has the name, and takes it. Throws
  // std::runtime_error, which names it, when it is not given back in time; std::logic_error at a second call.
  void take(const std::string& name, double timeout);

 private:
  std::string name_;  // empty without one
};

}  // namespace laparoscope_servo
