#include "screen/features/features_panel.h"

#include <QPainter>
#include <QScrollArea>

#include "screen/fitted_text.h"
#include "screen/level_symbol.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kHeight = 74;    // px of a line
constexpr int kStripe = 26;    // px, with the symbol
constexpr int kRow = 17;       // px
constexpr int kSmallest = 10;  // px of the font, of a text that is too long otherwise

const QColor kQuiet(0xb4, 0xbc, 0xc8);

}  // namespace

FeatureLine::FeatureLine(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kHeight);
}

void FeatureLine::show(const QString& name, const BandText& text) {
  if (name != name_ || !(text == text_)) {
    name_ = name;
    text_ = text;
    setObjectName("features_" + name);
    setToolTip(QString::fromStdString(text.detail).toHtmlEscaped());
    update();
  }
  setVisible(true);
}

void FeatureLine::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), QColor(0x16, 0x1a, 0x20));
  painter.fillRect(QRect(0, 0, kStripe, height()), levelColour(text_.level));
  drawLevelSymbol(painter, text_.level, QPointF(kStripe / 2.0, height() / 2.0), 8.0);
  const int left = kStripe + 6, width = this->width() - left - 4;
  QFont font = this->font();
  font.setPixelSize(14);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(Qt::white);
  const QString head = name_ + ": " + QString::fromStdString(text_.word);
  painter.drawText(QRect(left, 2, width, kRow), Qt::AlignLeft | Qt::AlignVCenter,
                   QFontMetrics(font).elidedText(head, Qt::ElideRight, width));
  font.setPixelSize(12);
  font.setBold(false);
  painter.setFont(font);
  const QString why = QString::fromStdString(text_.sentence);
  painter.drawText(QRect(left, 2 + kRow, width, kRow), Qt::AlignLeft | Qt::AlignVCenter,
                   QFontMetrics(font).elidedText(why, Qt::ElideRight, width));
  painter.setPen(kQuiet);
  drawFitted(painter, QRectF(left, 2 + 2 * kRow, width, 2 * kRow), QString::fromStdString(text_.cure), font, kSmallest);
}

FeaturesPanel::FeaturesPanel(const std::function<void(bool)>& draw, QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(box_ = new QCheckBox("Draw them in the picture", this));
  box_->setObjectName("draw_features");
  box_->setChecked(true);
  box_->setFocusPolicy(Qt::NoFocus);
  connect(box_, &QCheckBox::toggled, this, draw);
  auto* area = new QScrollArea(this);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setFocusPolicy(Qt::NoFocus);
  auto* content = new QWidget(area);
  content->setObjectName("features");
  rows_ = new QVBoxLayout(content);
  rows_->setContentsMargins(0, 0, 0, 0);
  rows_->setSpacing(4);
  rows_->addWidget(none_ = new QLabel("No tracker of features runs here.", content));
  none_->setTextFormat(Qt::PlainText);
  rows_->addStretch(1);
  area->setWidget(content);
  layout->addWidget(area, 1);
}

void FeaturesPanel::show(const Facts& facts, double now) {
  none_->setVisible(facts.features.empty());
  while (lines_.size() < facts.features.size()) {
    lines_.push_back(new FeatureLine(none_->parentWidget()));
    rows_->insertWidget(rows_->count() - 1, lines_.back());
  }
  for (std::size_t k = 0; k < facts.features.size(); ++k) {
    const FeatureTrackerFacts& tracker = facts.features[k];
    lines_[k]->show(QString::fromStdString(tracker.name), featureBand(facts, tracker, now));
  }
}

}  // namespace laparoscope_servo::screen
