// What only the image, or the tracker itself, can say against one feature of a selection.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/feature_selection.h"

namespace laparoscope_servo::features {

// One of several features that were selected together: whoever knows its id puts it in front of the text.
class RefusedFeature : public std::invalid_argument {
 public:
  RefusedFeature(std::size_t index, const std::string& text) : std::invalid_argument(text), index_(index) {}
  std::size_t index() const { return index_; }

 private:
  std::size_t index_;
};

// Throws std::invalid_argument, with where it lies and the image's size, when nothing of a curve or region can be in an
// image of `size`. Its numbers have to be valid.
void checkInImage(const SelectedFeature& selected, const cv::Size& size);

}  // namespace laparoscope_servo::features
