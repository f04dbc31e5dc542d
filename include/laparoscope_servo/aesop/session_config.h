// How the driver talks to the controller. Defaults are those of config/aesop.yaml, group `link`.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

struct SessionConfig {
  double rate = 40.0;                 // Hz: requests sent, and so statuses asked for
  double time_to_live = 0.2;          // s: of a velocity; when none follows, the controller stops by itself
  double status_timeout = 0.3;        // s: no status for longer is a lost link
  double request_timeout = 1.0;       // s: for the controller to confirm enable, disable or clear_fault
  CodecFactory codec = makeOwnCodec;  // the wire format; by name: codecNamed()
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, SessionConfig& config);
// Its row `codec`, which other ends of the line have, too.
void describeCodec(parameters::Table& table, CodecFactory& codec);

std::vector<std::string> validate(const SessionConfig& config);

// Why the line cannot carry statuses at this rate (8N1: ten bits a byte), with figures; empty when it can, with 10 % to
// spare.
std::string lineWarning(const SessionConfig& config, int baud_rate);

}  // namespace laparoscope_servo::aesop
