// Weights of a level's pixels by which squares of the image can be used.
#pragma once

#include "motion/usable_pixels.h"
#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::motion {

// `side`: px of the image, of a square; `level`: of the whole image. A pixel that covers several squares has a weight
// if more than half of them can be used.
void setWeights(const Squares& squares, int side, tracking::EsmLevel& level);

}  // namespace laparoscope_servo::motion
