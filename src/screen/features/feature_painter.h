// Draws what the trackers of features say of the picture's image over the picture. Each kind, and each state, has a
// form of its own, not only a colour, and a line in the legend.
#pragma once

#include <QPainter>
#include <cstddef>
#include <optional>

#include "screen/facts.h"
#include "screen/letterbox.h"

namespace laparoscope_servo::screen {

const QColor kFeatureColour(0x60, 0xff, 0x60);
const QColor kOldFeatureColour(0xb8, 0xb8, 0xb8);
constexpr double kForgotten = 10.0;  // s: an older result is not drawn

constexpr std::size_t kFewFeatures = 8;  // of a tracker: of more only the one at the mouse has its name beside it

// Results of this very image in colour; of an earlier one in grey, with its age when that is above kOldest. `mouse`: in
// the widget; empty: elsewhere.
void drawFeatures(QPainter& painter, const Facts& facts, const Letterbox& letterbox,
                  const std::optional<QPointF>& mouse = std::nullopt);

// At the bottom right of `canvas`; nothing where it has no room beside the legend of the region.
void drawFeatureLegend(QPainter& painter, const QRectF& canvas);

}  // namespace laparoscope_servo::screen
