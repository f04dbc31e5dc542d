// Real-time priority, for a loop that must keep its period on a busy machine.
#pragma once

#include <string>

namespace laparoscope_servo {

// Gives the calling thread (and no thread or process that it starts later) SCHED_FIFO at `priority`, 1 to 99, and keeps
// the process's memory from being paged out. Returns what was not permitted, and how to permit it; empty if all was.
std::string goRealtime(int priority);

}  // namespace laparoscope_servo
