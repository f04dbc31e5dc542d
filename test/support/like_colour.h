// Whether a pixel is of about a colour: edges are smoothed when they are drawn.
#pragma once

#include <QColor>
#include <cstdlib>

namespace laparoscope_servo::test_support {

inline bool isLike(const QColor& pixel, const QColor& colour) {
  return std::abs(pixel.red() - colour.red()) + std::abs(pixel.green() - colour.green()) +
             std::abs(pixel.blue() - colour.blue()) <
         60;
}

}  // namespace laparoscope_servo::test_support
