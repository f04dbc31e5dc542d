// Why an area of the region of interest is hidden.
#pragma once

namespace laparoscope_servo::tracking {

// Why an area did not drive ESM, or hardly did: its colour differs, its structure differs, or at least half of its
// pixels are saturated or outside of the image. The values are those of AreaSelection.msg.
enum class AreaCause : unsigned char { kNone = 0, kColour = 1, kStructure = 2, kHighlight = 3, kBorder = 4 };

}  // namespace laparoscope_servo::tracking
