#include "ros/common/name_turn.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

struct TakenNames {
  std::mutex mutex;
  std::condition_variable changed;
  std::set<std::string> names;
};

// Never destroyed: a manager that ends may destroy its nodelets after the static objects.
TakenNames& taken() {
  static auto* const names = new TakenNames;
  return *names;
}

}  // namespace

void NameTurn::take(const std::string& name, double timeout) {
  if (!name_.empty()) throw std::logic_error("a second name, " + name + ", for what is " + name_);
  TakenNames& all = taken();
  std::unique_lock<std::mutex> lock(all.mutex);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                            std::chrono::duration<double>(timeout));
  if (!all.changed.wait_until(lock, until, [&] { return all.names.count(name) == 0; })) {
    std::ostringstream text;
    text << "another " << name << " of this process has not ended within " << timeout << " s";
    throw std::runtime_error(text.str());
  }
  all.names.insert(name);
  name_ = name;
}

NameTurn::~NameTurn() {
  if (name_.empty()) return;
  TakenNames& all = taken();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.names.erase(name_);
  all.changed.notify_all();
}

}  // namespace laparoscope_servo
