// Who takes part in the test of convergence.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/support/contestant.h"

namespace laparoscope_servo::bench {

// `who` is
//   own    ESM alone, as configured by default but for the number of levels, and plain, as in the papers; the tracker
//   all    the same and the peers
//   parts  ESM alone with each model of light, with robust weights and without, with one level and three
// else std::invalid_argument. `max_iterations` per level; 0: those of the configuration, for plain ESM as many as ECC
// has, since the question is how far it gets and not how fast.
std::vector<std::unique_ptr<Contestant>> aligners(const std::string& who, int max_iterations);

}  // namespace laparoscope_servo::bench
