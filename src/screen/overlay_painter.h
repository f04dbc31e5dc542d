// Draws the tracker's result for this very image over the picture: where the region is (a solid outline), where it
// shall be (a dashed one with marked corners), where the recorded result has it, and which of its areas are hidden, and
// by what (hatched, a form for each cause). Each has a form of its own, not only a colour, and a line in the legend.
#pragma once

#include <QColor>
#include <QPainter>
#include <QPolygonF>

#include "screen/facts.h"
#include "screen/letterbox.h"

namespace laparoscope_servo::screen {

const QColor kPresentColour(0xff, 0xe0, 0x30);
const QColor kTargetColour(0x40, 0xe0, 0xff);
const QColor kCasing(0, 0, 0, 200);     // about every line, so that it is seen over anything
constexpr double kLegendWidth = 220.0;  // px

void drawOverlay(QPainter& painter, const Facts& facts, const Letterbox& letterbox);

// One area, hatched by what hides it; nothing when it is visible. Without a pen.
void drawHiddenArea(QPainter& painter, const QPolygonF& shape, const Areas& areas, std::size_t area);

// At the bottom left of `canvas`. `recorded`: with the line for what was said when it was recorded.
void drawLegend(QPainter& painter, const QRectF& canvas, bool recorded);

// The box about the region where it is now, in the widget; empty when it is not known.
std::optional<QRectF> presentRegion(const Facts& facts, const Letterbox& letterbox);

}  // namespace laparoscope_servo::screen
