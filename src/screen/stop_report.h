// What STOP has come to, in words, from the answers of controller and arm. Uses no ROS and no widgets.
#pragma once

#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

class StopReport {
 public:
  enum class Node { kController, kArm };

  // For no connection to a ROS master.
  StopReport() = default;
  // `facts`: those at the press of STOP, which say who is there.
  explicit StopReport(const Facts& facts);

  // The answer to controller/engage (false) or aesop/disable.
  void answered(Node node, const Answer& answer);
  // Done when each node that is there has confirmed. A node that was there once, and cannot be asked any more, counts
  // as one that did not confirm.
  Answer answer() const;

 private:
  enum class Presence { kUnseen, kThere, kEnded };
  struct Part {
    Presence presence = Presence::kUnseen;
    Answer answer;
    bool absent() const;
    std::string words(const std::string& who, const std::string& done) const;
  };
  static Presence presenceOf(bool connected, bool heard);

  bool connected_ = false;
  Part controller_, arm_;
};

}  // namespace laparoscope_servo::screen
