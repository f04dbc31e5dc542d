#include "laparoscope_servo/sim/emulator_control.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace laparoscope_servo::sim {

namespace {

using Words = std::vector<std::string>;

Words split(const std::string& line) {
  std::istringstream stream(line);
  Words words;
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

std::string answerRecord(const Emulator& emulator, double now) {
  const auto age = [](double value) { return std::isfinite(value) ? value : -1.0; };
  std::ostringstream text;
  text << std::setprecision(12) << "ok " << age(emulator.velocityAge(now)) << ' '
       << age(now - emulator.arm().movedUntil()) << ' ' << emulator.longestMotion();
  return text.str();
}

std::string verdict(const std::string& error) {
  return error.empty() ? "ok" : "error " + error;
}

std::string answerHand(const Words& words, Emulator& emulator, double now) {
  std::array<double, 5> values{};
  if (words.size() != 6) return "error hand takes five numbers: pan, tilt, spin [rad], insertion [m], seconds";
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!number(words[k + 1], values[k])) return "error '" + words[k + 1] + "' is not a number";
  }
  return verdict(emulator.hand({values[0], values[1], values[2], values[3]}, values[4], now));
}

// fault <name> [value] [to_controller|to_host] [for <s>], starting with the word `fault`. Returns the error, or an
// empty text.
std::string parseFault(const Words& words, Fault& fault) {
  std::size_t k = 0;
  if (words.empty() || words[k++] != "fault" || words.size() < 2) return "expected fault and its name";
  fault.name = words[k++];
  const auto isValue = [](const std::string& word) { return word != "for" && word.rfind("to_", 0) != 0; };
  if (k < words.size() && isValue(words[k])) fault.value = words[k++];
  if (k < words.size() && words[k] != "for") fault.way = words[k++];
  if (k < words.size()) {
    if (words[k] != "for") return "'" + words[k] + "' is not expected behind a fault and its value";
    if (k + 2 != words.size() || !number(words[k + 1], fault.duration))
      return "for takes a number of seconds, and ends the line";
  }
  return error(fault);
}

std::string answerFault(const Words& words, Faults& faults, double now) {
  Fault fault;
  const std::string problem = parseFault(words, fault);
  return verdict(problem.empty() ? faults.begin(fault, now) : problem);
}

std::string answerAfter(const Words& words, Faults& faults, double now) {
  ScheduledFault fault;
  if (words.size() < 4 || !number(words[1], fault.at)) return "error after takes a number of seconds and a fault";
  const std::string problem = parseFault(Words(words.begin() + 2, words.end()), fault.fault);
  return verdict(problem.empty() ? faults.schedule(fault, now) : problem);
}

}  // namespace

std::string emulatorControlHelp() {
  return "state                                     true joint positions: ok <time s> <q1> ... <q7>, m and rad\n"
         "motion                                    ok <state> <moving> <faults> <qdot1> ... <qdot7>, m/s and rad/s\n"
         "record                                    ok <s since a velocity was taken> <s since a motor moved a joint>\n"
         "                                          <longest motion after a velocity taken, s>; -1: never\n"
         "hand <pan> <tilt> <spin> <insertion> <s>  move the scope about the trocar (rad, m) while DISABLED\n"
         "fault <name> [value] [to_controller|to_host] [for <s>]\n"
         "                                          a fault of those below, of the line both ways unless one is named\n"
         "after <s> fault ...                       the same, later\n"
         "forget                                    forget what was to begin or end later\n"
         "Faults:\n" +
         faultHelp();
}

std::string answerControl(const std::string& request, Emulator& emulator, Faults& faults, double now) {
  faults.step(now);
  emulator.step(now);
  const Words words = split(request);
  if (words.empty()) return "error an empty request";
  if (words[0] == "hand") return answerHand(words, emulator, now);
  if (words[0] == "fault") return answerFault(words, faults, now);
  if (words[0] == "after") return answerAfter(words, faults, now);
  if (words.size() > 1) return "error " + words[0] + " takes no values";
  if (words[0] == "state") return answerState(emulator, now);
  if (words[0] == "motion") return answerMotion(emulator);
  if (words[0] == "record") return answerRecord(emulator, now);
  if (words[0] == "forget") {
    faults.forget();
    return "ok";
  }
  return "error there is no request '" + words[0] + "'";
}

}  // namespace laparoscope_servo::sim
