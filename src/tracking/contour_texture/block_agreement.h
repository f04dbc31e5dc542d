// How much of a region's texture the image shows where an alignment by ESM has it: block by block, by correlation.
#pragma once

#include <vector>

#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::tracking {

struct BlockAgreement {
  int blocks = 0;     // of the reference that have texture, and that the image shows
  int correlate = 0;  // of them, that correlate with it
  double share() const { return blocks > 0 ? static_cast<double>(correlate) / blocks : 0.0; }
};

// Of the level's reference and its warped image at the last iteration, in blocks of 12 px; only pixels that have a
// weight count. `noise`: grey levels, a block whose reference deviates by less than twice as much has no texture.
BlockAgreement blockAgreement(const EsmLevel& level, double noise, double min_correlation);

}  // namespace laparoscope_servo::tracking
