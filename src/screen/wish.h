// Tells whether what was asked for is still wanted when its answer comes. Thread-safe.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

namespace laparoscope_servo::screen {

class Wish {
 public:
  // Returns true until the next end(). May outlive the wish.
  using Holds = std::function<bool()>;

  Holds present() const {
    return [newest = number_, mine = number_->load()] { return *newest == mine; };
  }
  void end() { ++*number_; }

 private:
  std::shared_ptr<std::atomic<unsigned>> number_ = std::make_shared<std::atomic<unsigned>>(0u);
};

}  // namespace laparoscope_servo::screen
