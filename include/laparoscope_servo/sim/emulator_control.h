// What is not on the wire: the hand of a nurse, faults on demand, the truth about the joints. Lines of text, one answer
// each.
#pragma once

#include <string>

#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/wire.h"

namespace laparoscope_servo::sim {

// The requests, for a command-line help.
const char* emulatorControlHelp();

// Answers one request, without its line end: "ok", "ok <values>" or "error <why>". `now` as for the emulator.
//   state                                        ok <time s> <q1> ... <q7>             true joint positions, m and rad
//   motion                                       ok <state> <moving 0|1> <faults> <qdot1> ... <qdot7>
//   hand <pan> <tilt> <spin> <insertion> <s>     moves the scope about the trocar, rad and m, unless the arm is not
//   DISABLED fault drop|corrupt|double <probability>      of every byte, both ways fault delay <s> both ways fault
//   hangup [s] | fault return              takes the port away (for s seconds), brings it back fault bits <mask> cause
//   of a robot fault, until `fault bits 0` fault reboot                                 the controller restarts fault
//   none                                   a good line again, and no cause of a robot fault
std::string answerControl(const std::string& request, Emulator& emulator, Wire& wire, double now);

}  // namespace laparoscope_servo::sim
