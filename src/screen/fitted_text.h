// Draws a text of any length into a given area: in a smaller font where it is long, and shortened by "…" where that is
// not enough.
#pragma once

#include <QFont>
#include <QPainter>
#include <QString>

namespace laparoscope_servo::screen {

// Wrapped, from the top left on, with the painter's pen. `font`: its pixel size is the largest one. `smallest`: px,
// size below which the font does not go.
void drawFitted(QPainter& painter, const QRectF& area, const QString& text, QFont font, int smallest);

}  // namespace laparoscope_servo::screen
