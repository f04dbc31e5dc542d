// Which region the tracker offers in place of one that it refused or could not hold. Uses no ROS and no widgets.
#pragma once

#include <optional>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

// In the picture that is shown, the frozen or the live one; empty: none is offered.
std::optional<Offer> offerOf(const Facts& facts);

}  // namespace laparoscope_servo::screen
