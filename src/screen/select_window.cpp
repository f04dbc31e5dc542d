#include "screen/select_window.h"

#include <QKeyEvent>
#include <QVBoxLayout>

#include "screen/region_painter.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kQuiet = 30;    // ms
constexpr double kNow = 0.0;  // s: time stands still for a picture that does

const char* const kHelp =
    "Draw the region with the mouse; take it inside or at a corner to change it, or move it by the arrow keys.\n"
    "Enter starts with it, Escape ends.";

}  // namespace

SelectWindow::SelectWindow(const QImage& picture, const QSize& original, const Judge& judge) : judge_(judge) {
  facts_.picture.image = picture;
  facts_.picture.arrived_at = facts_.picture.changed_at = kNow;
  facts_.tracker.width = original.width();
  facts_.tracker.height = original.height();
  image_ = new ImageView([this](const QRect& region) { take(region); },
                         [this](const QRect& region) {
                           changed_ = region;
                           quiet_.start(kQuiet);
                         },
                         this);
  image_->keepDrafts();
  words_ = new QLabel(kHelp, this);
  words_->setObjectName("words");
  words_->setTextFormat(Qt::PlainText);
  words_->setWordWrap(true);
  setStyleSheet("QWidget { background: #10131a; } QLabel { color: white; font-size: 15px; padding: 4px; }");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(image_, 1);
  layout->addWidget(words_);
  quiet_.setSingleShot(true);
  connect(&quiet_, &QTimer::timeout, this, [this] { this->judge(changed_); });
  image_->show(facts_, kNow);
  image_->setFocus();
}

void SelectWindow::judge(const QRect& region) {
  facts_.verdict = judge_(region);
  facts_.verdict->region = region;
  image_->show(facts_, kNow);
}

void SelectWindow::take(const QRect& region) {
  judge(region);
  if (!facts_.verdict->taken) return words_->setText("Not taken: " + wordsOf(*facts_.verdict));
  selected_ = region;
  close();
}

void SelectWindow::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) {
    close();
  } else if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
    words_->setText(QString("There is no region yet. ") + kHelp);
  } else {
    QWidget::keyPressEvent(event);
  }
}

}  // namespace laparoscope_servo::screen
