// What is not on the wire: the hand of a nurse, faults on demand, the truth about the joints. Lines of text, one answer
// each; doc/aesop_emulator.md lists them.
#pragma once

#include <string>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo::sim {

// The requests, for a command-line help.
std::string emulatorControlHelp();

// Answers one request, without its line end: "ok", "ok <values>" or "error <why>". `now` as for the emulator.
std::string answerControl(const std::string& request, Emulator& emulator, Faults& faults, double now);

}  // namespace laparoscope_servo::sim
