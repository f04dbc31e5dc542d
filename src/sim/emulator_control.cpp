#include "laparoscope_servo/sim/emulator_control.h"

#include <array>
#include <iomanip>
#include <sstream>
#include <vector>

namespace laparoscope_servo::sim {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

bool number(const std::string& word, double& value) {
  std::istringstream stream(word);
  return (stream >> value) && stream.eof();
}

void append(const aesop::JointVector& values, std::ostringstream& text) {
  for (int k = 0; k < aesop::kJoints; ++k) text << ' ' << values[k];
}

std::string answerState(const Emulator& emulator, double now) {
  std::ostringstream text;
  text << std::setprecision(12) << "ok " << emulator.time(now);
  append(emulator.arm().position(), text);
  return text.str();
}

std::string answerMotion(const Emulator& emulator) {
  std::ostringstream text;
  text << std::setprecision(12) << "ok " << aesop::name(emulator.state()) << ' ' << (emulator.arm().isMoving() ? 1 : 0)
       << ' ' << emulator.faults();
  append(emulator.arm().velocity(), text);
  return text.str();
}

std::string verdict(const std::string& error) {
  return error.empty() ? "ok" : "error " + error;
}

std::string answerHand(const std::vector<std::string>& words, Emulator& emulator, double now) {
  std::array<double, 5> values{};
  if (words.size() != 6) return "error hand takes five numbers: pan, tilt, spin [rad], insertion [m], seconds";
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!number(words[k + 1], values[k])) return "error '" + words[k + 1] + "' is not a number";
  }
  return verdict(emulator.hand({values[0], values[1], values[2], values[3]}, values[4], now));
}

std::string answerFault(const std::vector<std::string>& words, Emulator& emulator, Wire& wire, double now) {
  if (words.size() < 2 || words.size() > 3) return "error fault takes a name and, for most, a value";
  const std::string& name = words[1];
  double value = 0.0;
  if (words.size() == 3 && !number(words[2], value)) return "error '" + words[2] + "' is not a number";
  const bool needs_value = name != "none" && name != "return" && name != "reboot" && name != "hangup";
  if (needs_value && words.size() != 3) return "error fault " + name + " takes a value";
  if (name == "reboot") {
    emulator.reboot(now);
    return "ok";
  }
  if (name == "bits") {
    if (!(value >= 0.0 && value <= 65535.0)) return "error bits takes 0 to 65535";
    emulator.setFaultCause(static_cast<std::uint16_t>(value), now);
    return "ok";
  }
  if (name == "none") emulator.setFaultCause(0, now);
  return verdict(wire.set(name, value, now));
}

}  // namespace

const char* emulatorControlHelp() {
  return "state                                     true joint positions: ok <time s> <q1> ... <q7>, m and rad\n"
         "motion                                    ok <state> <moving> <faults> <qdot1> ... <qdot7>, m/s and rad/s\n"
         "hand <pan> <tilt> <spin> <insertion> <s>  move the scope about the trocar (rad, m) while DISABLED\n"
         "fault drop|corrupt|double <probability>   of every byte, both ways\n"
         "fault delay <s>                           of every byte, both ways\n"
         "fault hangup [s], fault return            take the port away (for s seconds), bring it back\n"
         "fault bits <mask>                         cause of a robot fault; 0 takes it away\n"
         "fault reboot                              restart the controller\n"
         "fault none                                a good line and no cause of a fault\n";
}

std::string answerControl(const std::string& request, Emulator& emulator, Wire& wire, double now) {
  emulator.step(now);
  const std::vector<std::string> words = split(request);
  if (words.empty()) return "error an empty request";
  if (words[0] == "hand") return answerHand(words, emulator, now);
  if (words[0] == "fault") return answerFault(words, emulator, wire, now);
  if (words.size() > 1) return "error " + words[0] + " takes no values";
  if (words[0] == "state") return answerState(emulator, now);
  if (words[0] == "motion") return answerMotion(emulator);
  return "error there is no request '" + words[0] + "'";
}

}  // namespace laparoscope_servo::sim
