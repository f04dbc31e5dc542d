// Parameters of the session with the controller. Defaults are those of config/aesop.yaml, group `link`.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

struct SessionConfig {
  double rate = 40.0;                 // Hz: rate of requests, each of which is answered by a status
  double time_to_live = 0.2;          // s: validity of a velocity, after which the controller stops by itself
  double status_timeout = 0.3;        // s: the link is lost if there is no status for longer
  double request_timeout = 1.0;       // s: for the controller to confirm enable, disable or clear_fault
  CodecFactory codec = makeOwnCodec;  // the wire format; by name: see codecNamed()
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, SessionConfig& config);
// Adds the row `codec`, which other ends of the line have too.
void describeCodec(parameters::Table& table, CodecFactory& codec);

std::vector<std::string> validate(const SessionConfig& config);

// Warning, with figures, if the line cannot carry statuses at this rate (8N1: ten bits a byte) with 10 % to spare; else
// empty.
std::string lineWarning(const SessionConfig& config, int baud_rate);

}  // namespace laparoscope_servo::aesop
