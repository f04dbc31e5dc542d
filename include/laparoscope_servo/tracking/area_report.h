// Which areas of the region of interest (ROI) count as occluded, and why.
#pragma once

#include <vector>

namespace laparoscope_servo::tracking {

// Why an area did not drive ESM, or hardly did: its colour differs, its structure differs, or at least half of its
// pixels are saturated or outside of the image. The values are those of AreaSelection.msg.
enum class AreaCause : unsigned char { kNone = 0, kColour = 1, kStructure = 2, kHighlight = 3, kBorder = 4 };

// The ROI's areas, row by row. Empty while no ROI is selected.
struct AreaReport {
  int rows = 0;
  int columns = 0;
  std::vector<float> distance;  // eq. (2), 0 to 1; NaN where an area could not be compared
  std::vector<bool> occluded;   // true: the area did not drive ESM
  std::vector<AreaCause> cause;
};

}  // namespace laparoscope_servo::tracking
