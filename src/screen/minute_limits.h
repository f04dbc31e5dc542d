// The nodes' present limits for these figures.
#pragma once

#include "screen/facts.h"
#include "screen/minute_panel.h"

namespace laparoscope_servo::screen {

MinutePanel::Limits minuteLimits(const Facts& facts);

}  // namespace laparoscope_servo::screen
