// Faults that nobody here thought of: others have reported them of their cameras, grabbers, drivers, pads and robots.
#pragma once

#include <vector>

#include "fault_table.h"

namespace laparoscope_servo::test {

// Lines of the fault table.
std::vector<FaultRow> reportedFaults();
// Those of arms, lines, processes, machines and clocks, which are among them.
std::vector<FaultRow> reportedRobotFaults();

}  // namespace laparoscope_servo::test
