// The rows of the table of reasons, one file for each node.
#pragma once

#include <vector>

#include "ros/reasons/reason_table.h"

namespace laparoscope_servo {

const std::vector<ReasonRow>& trackerReasons();
const std::vector<ReasonRow>& featureReasons();
const std::vector<ReasonRow>& controllerReasons();
const std::vector<ReasonRow>& robotReasons();
const std::vector<ReasonRow>& playerReasons();

}  // namespace laparoscope_servo
