#include "screen/recording_bar.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <QPainter>
#include <cmath>

#include "screen/fitted_text.h"
#include "screen/level_symbol.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kSilence = 5.0;     // s: the recorder speaks once a second
constexpr double kForgotten = 60.0;  // s: a recorder that was ended on purpose is no news any more
constexpr int kHeight = 28;          // px
constexpr int kStripe = 26;          // px, with the symbol
constexpr int kSmallest = 9;         // px of the font

}  // namespace

BandText recordingText(const RecorderFacts& recorder, double now) {
  using diagnostic_msgs::DiagnosticStatus;
  if (recorder.heard_at < 0.0) return {};
  const double silence = now - recorder.heard_at;
  if (silence > kForgotten) return {};
  if (!(silence <= kSilence))
    return {"NOT RECORDING", "The recorder has ended, or is silent.", "", recorder.message, Level::kWaiting};
  if (recorder.level >= DiagnosticStatus::ERROR)
    return {"NOT RECORDING", recorder.message, "", recorder.message, Level::kBad};
  const std::string file = recorder.file + ", " + recorder.written + " MB; " + recorder.free + " MB free";
  if (recorder.level == DiagnosticStatus::WARN)
    return {"RECORDING WITH GAPS", recorder.message + "; " + file, "", recorder.message, Level::kWaiting};
  return {"RECORDING", file, "", recorder.message, Level::kGood};
}

RecordingBar::RecordingBar(QWidget* parent) : QWidget(parent) {
  setObjectName("recording");
  setFixedHeight(kHeight);
  setVisible(false);
}

void RecordingBar::show(const BandText& text) {
  if (text == text_) return;
  text_ = text;
  setVisible(!text.word.empty());
  setToolTip(QString::fromStdString(text.sentence).toHtmlEscaped());
  update();
}

void RecordingBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), QColor(0x16, 0x1a, 0x20));
  painter.fillRect(QRect(0, 0, kStripe, height()), levelColour(text_.level));
  drawLevelSymbol(painter, text_.level, QPointF(kStripe / 2.0, height() / 2.0), 7.0);
  QFont font = this->font();
  font.setPixelSize(15);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(Qt::white);
  const QString word = QString::fromStdString(text_.word);
  const int left = kStripe + 8;
  painter.drawText(QRect(left, 0, width() - left, height()), Qt::AlignLeft | Qt::AlignVCenter, word);
  const int beside = left + QFontMetrics(font).horizontalAdvance(word) + 12;
  font.setPixelSize(13);
  font.setBold(false);
  drawFitted(painter, QRectF(beside, 2, width() - beside - 4, height() - 4), QString::fromStdString(text_.sentence),
             font, kSmallest);
}

}  // namespace laparoscope_servo::screen
