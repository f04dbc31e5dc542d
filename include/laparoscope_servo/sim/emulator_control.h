// Control of the emulator beside the wire: a nurse's hand, faults on demand, the true joint positions. Lines of text
// with one answer each; doc/aesop_emulator.md lists them.
#pragma once

#include <string>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo::sim {

// Help text of the requests.
std::string emulatorControlHelp();

// Answers one request, without its line end: "ok", "ok <values>" or "error <why>". `now` as for the emulator.
std::string answerControl(const std::string& request, Emulator& emulator, Faults& faults, double now);

}  // namespace laparoscope_servo::sim
