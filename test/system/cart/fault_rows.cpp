#include "fault_rows.h"

#include <utility>

namespace laparoscope_servo::test {

FaultRow other(const std::string& name, unsigned usually, unsigned otherwise, Outcome outcome,
               const std::string& states, const Begin& begin, const Begin& end) {
  FaultRow row;
  row.name = name;
  row.usually = usually;
  row.otherwise = otherwise;
  row.outcome = outcome;
  row.states = states;
  row.begin = begin;
  row.end = end;
  return row;
}

FaultRow image(const std::string& name, unsigned usually, Outcome outcome, const std::string& states,
               const std::function<ImageRelay::Fault()>& fault) {
  return other("images: " + name, usually, kServo | kHold, outcome, states,
               [fault](FaultCart& cart) { cart.relay->begin(fault()); });
}

FaultRow inTurn(const std::string& name, std::size_t count) {
  FaultRow row = image(name + " in turn", kServo, Outcome::kStands, kDoubted, {});
  row.begin = [count](FaultCart& cart) { cart.relay->begin(image_faults::inTurn(cart.relay->last(count))); };
  return row;
}

FaultRow stranger(const std::string& name, unsigned usually, unsigned otherwise, Outcome outcome,
                  const std::string& states, const std::string& topic, const std::string& says, double rate,
                  const Begin& begin) {
  FaultRow row = other(name, usually, otherwise, outcome, states, begin);
  row.stranger = topic;
  row.says = says;
  row.rate = rate;
  return row;
}

FaultRow alsoInOtherTasks(FaultRow row) {
  row.usually |= row.outcome == Outcome::kStands ? kOtherTasks | kParallel : kOtherTasks;
  return row;
}

FaultRow watched(FaultRow row, double seconds) {
  row.watched = seconds;
  return row;
}

FaultRow process(const std::string& name, std::unique_ptr<ChildProcess> FaultCart::*victim, int signal,
                 const Begin& again, const std::string& states) {
  return other(
      name, kServo, kAll, Outcome::kStands, states, [=](FaultCart& cart) { (cart.*victim)->kill(signal); },
      [=](FaultCart& cart) {
        if (signal == SIGSTOP) {
          (cart.*victim)->kill(SIGCONT);
        } else {
          again(cart);
        }
      });
}

std::vector<FaultRow> joined(std::initializer_list<std::vector<FaultRow> (*)()> parts) {
  std::vector<FaultRow> all;
  for (const auto part : parts) {
    for (FaultRow& row : part()) all.push_back(std::move(row));
  }
  return all;
}

}  // namespace laparoscope_servo::test
