#include "tracking/selection/selection_mask.h"

#include "laparoscope_servo/features/instrument_mask.h"
#include "tracking/roi_check.h"

namespace laparoscope_servo::tracking {

SelectionMask::SelectionMask(const cv::Mat& image, const cv::Mat& external)
    : instruments_(features::instrumentMask(image)) {
  field_.look(image);
  cv::Mat covered = external;
  if (!instruments_.empty()) covered = external.empty() ? instruments_ : cv::Mat(instruments_ | (external != 0));
  mask_ = field_.joined(covered);
}

void SelectionMask::check(const geometry::Rectangle& roi, const image::Lens* lens) const {
  checkWithinField(roi, field_, lens);
  checkClearOfInstruments(roi, instruments_, lens);
}

}  // namespace laparoscope_servo::tracking
