// Draws the tracker's result for this very image over the picture: where the region is (a solid outline), where it
// shall be (a dashed one with marked corners), and which of its areas are hidden, and by what (hatched, a form for each
// cause). Each has a form of its own, not only a colour, and a line in the legend.
#pragma once

#include <QPainter>

#include "screen/facts.h"
#include "screen/letterbox.h"

namespace laparoscope_servo::screen {

void drawOverlay(QPainter& painter, const Facts& facts, const Letterbox& letterbox);

// At the bottom left of `canvas`.
void drawLegend(QPainter& painter, const QRectF& canvas);

// The box about the region where it is now, in the widget; empty when it is not known.
std::optional<QRectF> presentRegion(const Facts& facts, const Letterbox& letterbox);

}  // namespace laparoscope_servo::screen
