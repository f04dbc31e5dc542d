#include "screen/image_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "screen/features/feature_painter.h"
#include "screen/overlay_painter.h"
#include "screen/region_offer.h"
#include "screen/region_painter.h"

namespace laparoscope_servo::screen {

namespace {

const QColor kAround(0x10, 0x12, 0x16);
const QColor kFrozen(0xff, 0xb0, 0x20);

// Text readable on any background: white in a dark box.
void drawWords(QPainter& painter, const QRectF& area, const QString& words, const QString& detail) {
  QFont font = painter.font();
  font.setPixelSize(56);
  font.setBold(true);
  const int natural = QFontMetrics(font).horizontalAdvance(words);
  if (natural > area.width() - 20) font.setStretch(std::max(40, static_cast<int>(100 * (area.width() - 20) / natural)));
  const QRectF box(area.left(), area.center().y() - 56, area.width(), 112);
  painter.fillRect(box, QColor(0, 0, 0, 200));
  painter.setPen(Qt::white);
  painter.setFont(font);
  painter.drawText(box.adjusted(0, 4, 0, -40), Qt::AlignCenter, words);
  font.setStretch(100);
  for (int size = 20; size >= 12; --size) {  // as large as it fits
    font.setPixelSize(size);
    if (QFontMetrics(font).horizontalAdvance(detail) <= area.width() - 20) break;
  }
  painter.setFont(font);
  painter.drawText(box.adjusted(0, 68, 0, -4), Qt::AlignCenter, detail);
}

// Whether both would be drawn alike.
bool sameFeatures(const std::vector<FeatureTrackerFacts>& a, const std::vector<FeatureTrackerFacts>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const FeatureTrackerFacts& x, const FeatureTrackerFacts& y) {
                      return x.name == y.name && x.drawn == y.drawn;
                    });
}

bool sameResults(const Facts& a, const Facts& b) {
  return a.result.has_value() == b.result.has_value() && a.areas.has_value() == b.areas.has_value() &&
         a.recorded.has_value() == b.recorded.has_value();
}

std::int64_t stampOf(const std::optional<Frozen>& frozen) {
  return frozen ? frozen->stamp : 0;
}

long secondsFrozen(const Facts& facts, double now) {
  return facts.frozen ? std::lround(now - facts.frozen->at) : -1;
}

bool sameVerdict(const std::optional<Verdict>& a, const std::optional<Verdict>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->region == b->region && a->stamp == b->stamp && a->taken == b->taken && a->why == b->why &&
         a->proposal == b->proposal;
}

// Whether the region that the user draws, or is offered, would be drawn alike.
bool sameDrawing(const Facts& a, const Facts& b) {
  return stampOf(a.frozen) == stampOf(b.frozen) && sameVerdict(a.verdict, b.verdict) && offerOf(a) == offerOf(b);
}

}  // namespace

ImageView::ImageView(const Region& drawn, const Region& changed, QWidget* parent)
    : QWidget(parent), drawn_(drawn), changed_(changed) {
  setObjectName("image");
  setMouseTracking(true);
  setFocusPolicy(Qt::ClickFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

// Repaints only if something has changed, since painting takes most of the screen's CPU time.
void ImageView::show(const Facts& facts, double now) {
  const PictureWords words = pictureWords(facts.picture, now, facts.playback);
  const bool same = facts.master == facts_.master && sameFeatures(facts.features, facts_.features) &&
                    facts.picture.arrived_at == facts_.picture.arrived_at && sameResults(facts, facts_) &&
                    facts.tracker.reference_stamp == facts_.tracker.reference_stamp &&
                    facts.tracker.width == facts_.tracker.width && facts.tracker.height == facts_.tracker.height &&
                    words.words == words_.words && words.detail == words_.detail && sameDrawing(facts, facts_) &&
                    secondsFrozen(facts, now) == secondsFrozen(facts_, now_);
  if (stampOf(facts.frozen) != stampOf(facts_.frozen)) cancelDrag();
  facts_ = facts;
  words_ = words;
  now_ = now;
  if (!same) update();
}

void ImageView::drawFeatures(bool draw) {
  draws_features_ = draw;
  update();
}

void ImageView::cancelDrag() {
  drag_.cancel();
  draft_.reset();
  update();
}

// On an outdated live picture no region can be drawn, since it would be cut from an image with another content or size;
// nor on the picture of a tracker of features, since no region tracker runs.
bool ImageView::canDraw() const {
  const bool regions = facts_.tracker.width > 0 && facts_.picture.original.isEmpty();
  return letterbox().isValid() && (facts_.frozen || (words_.live && regions));
}

std::optional<QRectF> ImageView::present() const {
  if (draft_) return letterbox().fromPixels(*draft_);
  return facts_.frozen ? std::nullopt : presentRegion(facts_, letterbox());
}

std::optional<QRect> ImageView::shown() const {
  const std::optional<QRectF> drag = drag_.shown();
  return drag ? std::optional<QRect>(letterbox().pixelsOf(*drag)) : draft_;
}

std::optional<Offer> ImageView::offer() const {
  if (!canDraw() || !offer_taken_ || drag_.isActive() || draft_) return std::nullopt;
  const std::optional<Offer> offered = offerOf(facts_);
  return offered == given_up_ ? std::nullopt : offered;
}

bool ImageView::isOffered(const QPointF& at) const {
  const std::optional<Offer> offered = offer();
  return offered && letterbox().fromPixels(offered->region).contains(at);
}

void ImageView::tellChange() {
  const std::optional<QRect> pixels = shown();
  update();
  if (!pixels || pixels->isEmpty() || *pixels == asked_) return;
  asked_ = *pixels;
  changed_(*pixels);
}

void ImageView::give(const QRect& pixels) {
  if (!keeps_drafts_) cancelDrag();
  if (!pixels.isEmpty()) drawn_(pixels);
}

// Letterbox of the original image, whose size the trackers publish; until then of the preview.
Letterbox ImageView::letterbox() const {
  if (facts_.frozen) return {facts_.frozen->size, QRectF(rect())};
  if (!facts_.picture.original.isEmpty()) return {facts_.picture.original, QRectF(rect())};
  const bool known = facts_.tracker.width > 0 && facts_.tracker.height > 0;
  const QSize size = known ? QSize(facts_.tracker.width, facts_.tracker.height) : facts_.picture.image.size();
  return {size, QRectF(rect())};
}

void ImageView::drawPicture(QPainter& painter, const QRectF& area) {
  const QImage& image = facts_.picture.image;
  if (image.isNull()) return;
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  if (words_.live) return painter.drawImage(area, image);
  painter.drawImage(area, image.convertToFormat(QImage::Format_Grayscale8));
  painter.fillRect(area, QColor(90, 90, 90, 110));
}

// Draws the frozen picture, with the live one small at the top right, since the arm may move meanwhile.
void ImageView::drawFrozen(QPainter& painter, const QRectF& area, double now) {
  const Frozen& frozen = *facts_.frozen;
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(area, frozen.image);
  const QSizeF small = 0.25 * area.size();
  const QRectF inset(area.right() - small.width() - 8, area.top() + 40, small.width(), small.height());
  drawPicture(painter, inset);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(kFrozen, 3));
  painter.drawRect(inset);
  QFont font = painter.font();
  font.setPixelSize(16);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(QPen(kFrozen, 6));
  painter.drawRect(area.adjusted(3, 3, -3, -3));
  painter.fillRect(QRectF(area.left(), area.top(), area.width(), 32), QColor(0, 0, 0, 200));
  painter.setPen(kFrozen);
  painter.drawText(QRectF(area.left() + 10, area.top(), area.width() - 20, 32), Qt::AlignLeft | Qt::AlignVCenter,
                   QString("FROZEN %1 s ago. Draw the region here; \"Live\" returns.").arg(now - frozen.at, 0, 'f', 0));
  painter.setPen(Qt::white);
  painter.drawText(inset, Qt::AlignHCenter | Qt::AlignBottom,
                   words_.live ? "live" : QString::fromStdString(words_.words));
}

void ImageView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), kAround);
  const Letterbox box = letterbox();
  const QRectF area = box.isValid() ? box.area() : QRectF(rect());
  if (facts_.frozen) {
    drawFrozen(painter, area, now_);
  } else {
    if (box.isValid()) drawPicture(painter, area);
    if (words_.live) drawOverlay(painter, facts_, box);
    if (words_.live && draws_features_) screen::drawFeatures(painter, facts_, box, mouse_);
    if (facts_.master) drawLegend(painter, rect(), facts_.recorded.has_value());
    if (facts_.master && draws_features_ && !facts_.features.empty()) drawFeatureLegend(painter, rect());
  }
  if (const std::optional<QRect> pixels = shown()) {
    const std::int64_t stamp = facts_.frozen ? facts_.frozen->stamp : 0;
    const bool told = facts_.verdict && facts_.verdict->region == *pixels && facts_.verdict->stamp == stamp;
    if (told && !facts_.verdict->proposal.isEmpty()) drawProposal(painter, box.fromPixels(facts_.verdict->proposal));
    drawRegion(painter, box.fromPixels(*pixels), *pixels, told ? &*facts_.verdict : nullptr, draft_ == pixels, rect());
  }
  if (const std::optional<Offer> offered = offer())
    drawOffer(painter, box.fromPixels(offered->region), *offered, rect());
  if (!words_.live && !facts_.frozen)
    drawWords(painter, area, QString::fromStdString(words_.words), QString::fromStdString(words_.detail));
}

void ImageView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) {
    if (const std::optional<Offer> offered = offer()) given_up_ = offered;
    return cancelDrag();
  }
  const Letterbox box = letterbox();
  if (!canDraw()) return;
  asked_ = {};
  drag_.press(event->localPos(), present(), box.area(), (event->modifiers() & Qt::ShiftModifier) != 0);
}

void ImageView::showCursor(const QPointF& at, bool anew) {
  if (isOffered(at)) return setCursor(Qt::PointingHandCursor);
  switch (RegionDrag::kindAt(at, present(), anew)) {
    case RegionDrag::Kind::kMove:
      return setCursor(Qt::SizeAllCursor);
    case RegionDrag::Kind::kResize:
      return setCursor(Qt::PointingHandCursor);
    default:
      return setCursor(Qt::CrossCursor);
  }
}

void ImageView::mouseMoveEvent(QMouseEvent* event) {
  mouse_ = event->localPos();
  if (draws_features_ && !facts_.features.empty()) update();  // the name of the feature there
  if (!drag_.isActive()) return showCursor(event->localPos(), (event->modifiers() & Qt::ShiftModifier) != 0);
  if (!(event->buttons() & Qt::LeftButton)) return cancelDrag();  // the release event was lost
  drag_.move(event->localPos());
  tellChange();
}

void ImageView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !drag_.isActive()) return;
  const std::optional<QRectF> region = drag_.release(event->localPos());
  update();
  if (!region) {
    if (isOffered(event->localPos())) offer_taken_(*offer());
    return;
  }
  if (!keeps_drafts_) return give(letterbox().pixelsOf(*region));
  const QRect pixels = letterbox().pixelsOf(*region);
  if (pixels.isEmpty()) return;
  draft_ = pixels;
  tellChange();
}

// Arrows move the region by one pixel, with Shift by ten; Return sends it, or takes the one that is offered.
void ImageView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
    if (draft_) return give(QRect(*draft_));
    if (const std::optional<Offer> offered = offer()) return offer_taken_(*offered);
  }
  const int step = (event->modifiers() & Qt::ShiftModifier) != 0 ? 10 : 1;
  QPoint by;
  if (event->key() == Qt::Key_Left) by = {-step, 0};
  if (event->key() == Qt::Key_Right) by = {step, 0};
  if (event->key() == Qt::Key_Up) by = {0, -step};
  if (event->key() == Qt::Key_Down) by = {0, step};
  if (by.isNull()) return QWidget::keyPressEvent(event);
  const std::optional<QRectF> from = present();
  if (drag_.isActive() || !canDraw() || !from) return;
  const QSize image = facts_.frozen ? facts_.frozen->size : QSize(facts_.tracker.width, facts_.tracker.height);
  QRect moved = letterbox().pixelsOf(*from).translated(by);
  moved.moveLeft(std::clamp(moved.left(), 0, std::max(0, image.width() - moved.width())));
  moved.moveTop(std::clamp(moved.top(), 0, std::max(0, image.height() - moved.height())));
  draft_ = moved;
  tellChange();
}

void ImageView::leaveEvent(QEvent*) {
  mouse_.reset();
  update();
}

void ImageView::hideEvent(QHideEvent*) {
  cancelDrag();
}

}  // namespace laparoscope_servo::screen
