// The part of the view that the task STABILISE keeps in its place.
#pragma once

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::servo {

// px: the middle half of an image of `width` x `height` px, in width and in height. Its task error stands for that of
// the view. About the middle of the image, pan and tilt move it hardly in depth and orientation, so that these two need
// not be controlled.
inline geometry::Rectangle viewRegion(double width, double height) {
  return {0.25 * width, 0.25 * height, 0.5 * width, 0.5 * height};
}

}  // namespace laparoscope_servo::servo
