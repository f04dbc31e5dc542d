#include "screen/image_view.h"

#include <QMouseEvent>
#include <QPainter>

#include "screen/overlay_painter.h"

namespace laparoscope_servo::screen {

namespace {

const QColor kAround(0x10, 0x12, 0x16);

// Text over anything: white, with a dark box about it.
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
  font.setPixelSize(20);
  font.setStretch(100);
  painter.setFont(font);
  painter.drawText(box.adjusted(0, 68, 0, -4), Qt::AlignCenter, detail);
}

}  // namespace

ImageView::ImageView(const std::function<void(const QRect&)>& drawn, QWidget* parent) : QWidget(parent), drawn_(drawn) {
  setObjectName("image");
  setMouseTracking(true);
  setFocusPolicy(Qt::ClickFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

// Painted is only what has changed: that is most of what the screen costs.
void ImageView::show(const Facts& facts, double now) {
  const PictureWords words = pictureWords(facts.picture, now);
  const bool same =
      facts.picture.arrived_at == facts_.picture.arrived_at && facts.result.has_value() == facts_.result.has_value() &&
      facts.areas.has_value() == facts_.areas.has_value() &&
      facts.tracker.reference_stamp == facts_.tracker.reference_stamp && facts.tracker.width == facts_.tracker.width &&
      facts.tracker.height == facts_.tracker.height && words.words == words_.words && words.detail == words_.detail;
  facts_ = facts;
  words_ = words;
  if (!same) update();
}

void ImageView::cancelDrag() {
  drag_.cancel();
  update();
}

// Of the original image, whose size the tracker tells; until then of the preview.
Letterbox ImageView::letterbox() const {
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

void ImageView::drawDrag(QPainter& painter) {
  const std::optional<QRectF> shown = drag_.shown();
  if (!shown) return;
  const Letterbox box = letterbox();
  const QRect pixels = box.pixelsOf(*shown);
  const QRectF outline = box.fromPixels(pixels);
  painter.setBrush(QColor(255, 255, 255, 40));
  painter.setPen(QPen(Qt::black, 4));
  painter.drawRect(outline);
  painter.setPen(QPen(Qt::white, 2));
  painter.drawRect(outline);
  QFont font = painter.font();
  font.setPixelSize(16);
  font.setBold(true);
  painter.setFont(font);
  const QString text = QString("%1 x %2 px").arg(pixels.width()).arg(pixels.height());
  const QRectF label(outline.left(), std::max(0.0, outline.top() - 24), 140, 22);
  painter.fillRect(label, QColor(0, 0, 0, 190));
  painter.setPen(Qt::white);
  painter.drawText(label, Qt::AlignCenter, text);
}

void ImageView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), kAround);
  const Letterbox box = letterbox();
  const QRectF area = box.isValid() ? box.area() : QRectF(rect());
  if (box.isValid()) drawPicture(painter, area);
  if (words_.live) drawOverlay(painter, facts_, box);
  drawLegend(painter, rect());
  drawDrag(painter);
  if (!words_.live)
    drawWords(painter, area, QString::fromStdString(words_.words), QString::fromStdString(words_.detail));
}

void ImageView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return cancelDrag();
  const Letterbox box = letterbox();
  // What is drawn would be cut from an image that looks otherwise, or has another size.
  if (!words_.live || facts_.tracker.width <= 0 || !box.isValid()) return;
  drag_.press(event->localPos(), presentRegion(facts_, box), box.area(), (event->modifiers() & Qt::ShiftModifier) != 0);
}

void ImageView::showCursor(const QPointF& at, bool anew) {
  switch (RegionDrag::kindAt(at, presentRegion(facts_, letterbox()), anew)) {
    case RegionDrag::Kind::kMove:
      return setCursor(Qt::SizeAllCursor);
    case RegionDrag::Kind::kResize:
      return setCursor(Qt::PointingHandCursor);
    default:
      return setCursor(Qt::CrossCursor);
  }
}

void ImageView::mouseMoveEvent(QMouseEvent* event) {
  if (!drag_.isActive()) return showCursor(event->localPos(), (event->modifiers() & Qt::ShiftModifier) != 0);
  if (!(event->buttons() & Qt::LeftButton)) return cancelDrag();  // its release went elsewhere
  drag_.move(event->localPos());
  update();
}

void ImageView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !drag_.isActive()) return;
  const std::optional<QRectF> region = drag_.release(event->localPos());
  update();
  if (!region) return;
  const QRect pixels = letterbox().pixelsOf(*region);
  if (!pixels.isEmpty()) drawn_(pixels);
}

void ImageView::hideEvent(QHideEvent*) {
  drag_.cancel();
}

}  // namespace laparoscope_servo::screen
