// How the lines of the fault table are made, by what is at fault.
#pragma once

#include <initializer_list>

#include "fault_table.h"

namespace laparoscope_servo::test {

constexpr unsigned kServo = static_cast<unsigned>(Situation::kServo);
constexpr unsigned kHold = static_cast<unsigned>(Situation::kHold);
constexpr unsigned kManual = static_cast<unsigned>(Situation::kManual);
constexpr unsigned kAll = kServo | kHold | kManual;
constexpr unsigned kOtherTasks = static_cast<unsigned>(Situation::kFollow) | static_cast<unsigned>(Situation::kPoints) |
                                 static_cast<unsigned>(Situation::kPosition);
constexpr unsigned kParallel = static_cast<unsigned>(Situation::kParallel);

// States of the controller that a fault may lead to: what is missing may come again, or the picture is doubted.
constexpr char kLost[] = "HOLD LOST", kDoubted[] = "HOLD LOST FAULT";

using Begin = std::function<void(FaultCart&)>;

// Of the camera. What a task without a camera is driven by does not count, and a held scope needs a picture to go on.
FaultRow image(const std::string& name, unsigned usually, Outcome outcome, const std::string& states,
               const std::function<ImageRelay::Fault()>& fault);

// The last pictures, over and over.
FaultRow inTurn(const std::string& name, std::size_t count);

FaultRow other(
    const std::string& name, unsigned usually, unsigned otherwise, Outcome outcome, const std::string& states,
    const Begin& begin, const Begin& end = [](FaultCart&) {});

// Another publisher: `begin` is what happens beside it.
FaultRow stranger(
    const std::string& name, unsigned usually, unsigned otherwise, Outcome outcome, const std::string& states,
    const std::string& topic, const std::string& says, double rate, const Begin& begin = [](FaultCart&) {});

// Also in the tasks FOLLOW, POINTS and POSITION, and what stops it also on PARALLEL's circle, which ends by itself; by
// the test of these.
FaultRow alsoInOtherTasks(FaultRow row);

// What comes of it shows later: a loop that swings, a fault that grows. `seconds`: how long it is watched.
FaultRow watched(FaultRow row, double seconds);

// A process gets a signal; after SIGSTOP it is continued in the end, otherwise `again` starts it.
FaultRow process(const std::string& name, std::unique_ptr<ChildProcess> FaultCart::*victim, int signal,
                 const Begin& again, const std::string& states);

// The rows of all parts, in their order.
std::vector<FaultRow> joined(std::initializer_list<std::vector<FaultRow> (*)()> parts);

}  // namespace laparoscope_servo::test
