// Draws the region that is being drawn, with a tick or a cross for whether the tracker would accept it, and the reason.
#pragma once

#include <QPainter>
#include <QRect>
#include <QString>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

// The reason as a sentence, and what to do.
QString wordsOf(const Verdict& verdict);

// `outline` in the widget, `pixels` of the original image. `verdict`: null while the tracker has not answered.
// `by_keys`: moved by keys and not sent to the tracker yet. The text stays within `canvas`.
void drawRegion(QPainter& painter, const QRectF& outline, const QRect& pixels, const Verdict* verdict, bool by_keys,
                const QRectF& canvas);

// One that the tracker would take instead, in the widget.
void drawProposal(QPainter& painter, const QRectF& outline);

// The same with words, to be taken by a click or a key. The text stays within `canvas`.
void drawOffer(QPainter& painter, const QRectF& outline, const Offer& offer, const QRectF& canvas);

}  // namespace laparoscope_servo::screen
