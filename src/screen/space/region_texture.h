// The region as it is seen now, straightened: what is drawn on its quadrilateral in space.
#pragma once

#include <QImage>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

// `side` px wide and high, whatever the region's form: its corners are those of the picture. Areas that are hidden are
// hatched as over the picture; a solid outline says that the region is there, a dotted one that it is looked for there.
// Null when it is not known where the region is.
QImage regionTexture(const Facts& facts, int side);

// White words on a dark ground, with a frame of their own.
QImage labelTexture(const QString& text, const QColor& frame);

}  // namespace laparoscope_servo::screen
