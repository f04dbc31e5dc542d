#include "screen/fitted_text.h"

#include <gtest/gtest.h>

#include <QImage>
#include <string>

#include "ros/reasons/reason_table.h"
#include "screen/fitted_label.h"
#include "screen/task_words.h"

namespace laparoscope_servo::screen {
namespace {

constexpr int kWidth = 340, kHeight = 32;  // px

QImage drawn(const QString& text, int smallest = 10, const QSize& size = {kWidth, kHeight}, bool bold = true) {
  QImage image(size + QSize(40, 40), QImage::Format_RGB32);
  image.fill(Qt::black);
  QPainter painter(&image);
  painter.setPen(Qt::white);
  QFont font;
  font.setPixelSize(13);
  font.setBold(bold);
  drawFitted(painter, QRectF(QPointF(20, 20), size), text, font, smallest);
  return image;
}

// The part that is painted.
QRect ink(const QImage& image) {
  QRect box;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.pixel(x, y) != qRgb(0, 0, 0)) box |= QRect(x, y, 1, 1);
    }
  }
  return box;
}

const QRect kArea(20, 20, kWidth, kHeight);

TEST(FittedText, ATextOfAnyLengthStaysInItsArea) {
  for (const int length : {1, 40, 100, 200, 1000}) {
    QString words, one;
    for (int k = 0; words.size() < length; ++k) words += k % 5 == 4 ? ' ' : 'g';
    one.fill('W', length);
    for (const QString& text : {words, one}) {
      const QRect box = ink(drawn(text));
      EXPECT_FALSE(box.isEmpty()) << length;
      // Ink may pass the edge of its letter by a pixel.
      EXPECT_TRUE(kArea.adjusted(-1, 0, 1, 1).contains(box)) << length << ": " << box.bottom() << ", " << box.right();
    }
  }
}

TEST(FittedText, AShortTextKeepsItsSize) {
  const QString text = "The region is followed.";
  EXPECT_EQ(drawn(text), drawn(text, 13));
}

TEST(FittedText, ALongOneIsSmallerBeforeItIsShortened) {
  QString text;
  while (text.size() < 90) text += "region ";
  EXPECT_NE(drawn(text), drawn(text + "and its last word"));
  EXPECT_NE(drawn(text, 13), drawn(text, 10)) << "a smaller font";
  const QString much = text + text + text;
  EXPECT_EQ(drawn(much), drawn(much + "of which nothing is seen")) << "shortened, so that its end is not there";
}

TEST(FittedText, LinesOfATextAreLines) {
  EXPECT_GT(ink(drawn("a\na")).height(), ink(drawn("a a")).height());
  EXPECT_EQ(drawn("").size(), QSize(kWidth + 40, kHeight + 40));
}

// Nothing of what the table says is shortened in a band of the screen.
TEST(FittedText, EverySentenceOfTheTableFitsABand) {
  for (const Speaker speaker : {Speaker::kTracker, Speaker::kController, Speaker::kRobot}) {
    for (const ReasonRow& row : reasonRows(speaker)) {
      for (const std::string& text : {row.sentence, row.cure}) {
        const QString whole = QString::fromStdString(text);
        EXPECT_NE(drawn(whole), drawn(whole + "xx")) << text;
      }
    }
  }
}

// Beside the button of the task, in three lines on a display of 768 px.
TEST(FittedText, WhatATaskWillDoIsReadWhole) {
  for (const TaskWords& words : taskWords()) {
    for (const bool engaged : {false, true}) {
      for (const std::string current : {"HOLD_VIEW", "STABILISE"}) {
        const QString whole = QString::fromStdString(promise(words, current, engaged, false));
        const QSize room(276, 42);
        EXPECT_NE(drawn(whole, 11, room, false), drawn(whole + "xx", 11, room, false)) << whole.toStdString();
      }
    }
  }
}

TEST(FittedLabel, ItsSizeDoesNotDependOnItsText) {
  FittedLabel label("answer", 42, 54, nullptr);
  const QSize before = label.minimumSizeHint(), wanted = label.sizeHint();
  label.say(QString(3000, 'w') + "<b>x</b>");
  EXPECT_EQ(label.minimumSizeHint(), before);
  EXPECT_EQ(label.sizeHint(), wanted);
  EXPECT_TRUE(label.toolTip().endsWith("&lt;b&gt;x&lt;/b&gt;")) << "all of it, and no markup";
  label.resize(410, 54);
  label.grab();
}

}  // namespace
}  // namespace laparoscope_servo::screen
