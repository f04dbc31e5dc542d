// Messages for tests: one of each, with values that are not 0.
#pragma once

#include <vector>

#include "aesop/protocol/own_codec.h"

namespace laparoscope_servo::aesop {

inline Status someStatus() {
  Status status;
  status.state = RobotState::kEnabled;
  status.homed = true;
  status.moving = true;
  status.faults = 0x8002;
  status.echo = 0xFFFE;
  status.time = 12.345;
  status.position << 0.25, -0.9, 1.5, 0.0, 0.001, -0.002, -12.5;
  status.velocity << -0.0004, 0.003, 0.0, 0.0, 1e-6, -1e-6, 0.5;
  return status;
}

inline std::vector<Message> oneOfEach() {
  return {Identify(),
          Enable(),
          Disable(),
          Stop(),
          ClearFault(),
          Poll(),
          Velocity{{0.001, -0.3, 0.2, -0.5}, 0.2},
          Identity{7, 0x47, "emulator"},
          someStatus()};
}

}  // namespace laparoscope_servo::aesop
