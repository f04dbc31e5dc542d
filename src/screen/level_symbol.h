// The colour and the form of a level: each has its own form, for users who cannot distinguish the colours.
#pragma once

#include <QColor>
#include <QPainter>

#include "screen/band_text.h"

namespace laparoscope_servo::screen {

QColor levelColour(Level level);

// `radius`: px.
void drawLevelSymbol(QPainter& painter, Level level, const QPointF& centre, double radius);

}  // namespace laparoscope_servo::screen
