// Draws a region that is being drawn, and whether the tracker would take it: a tick or a cross, and why not, in words.
#pragma once

#include <QPainter>
#include <QRect>
#include <QString>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

// A sentence, and what to do.
QString wordsOf(const Verdict& verdict);

// `outline` in the widget, `pixels` of the original image. `verdict`: null while the tracker has not answered.
// `by_keys`: it is not given to the tracker yet. The words stay within `canvas`.
void drawRegion(QPainter& painter, const QRectF& outline, const QRect& pixels, const Verdict* verdict, bool by_keys,
                const QRectF& canvas);

// One that the tracker would take instead, in the widget.
void drawProposal(QPainter& painter, const QRectF& outline);

}  // namespace laparoscope_servo::screen
