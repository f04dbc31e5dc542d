// Draws what the trackers of features say of the picture's image over the picture. Each kind, and each state, has a
// form of its own, not only a colour, and a line in the legend.
#pragma once

#include <QPainter>

#include "screen/facts.h"
#include "screen/letterbox.h"

namespace laparoscope_servo::screen {

const QColor kFeatureColour(0x60, 0xff, 0x60);
const QColor kOldFeatureColour(0xb8, 0xb8, 0xb8);
constexpr double kForgotten = 10.0;  // s: an older result is not drawn

// Results of this very image in colour; of an earlier one in grey, with its age when that is above kOldest.
void drawFeatures(QPainter& painter, const Facts& facts, const Letterbox& letterbox);

// At the bottom right of `canvas`; nothing where it has no room beside the legend of the region.
void drawFeatureLegend(QPainter& painter, const QRectF& canvas);

}  // namespace laparoscope_servo::screen
