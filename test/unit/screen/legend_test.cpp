#include "screen/legend.h"

#include <gtest/gtest.h>

#include <QImage>
#include <vector>

namespace laparoscope_servo::screen {
namespace {

const QSize kCanvas(400, 200);

struct Drawn {
  QImage image{kCanvas, QImage::Format_RGB32};
  std::vector<QRectF> samples;
};

Drawn drawn(Legend::Corner corner, const std::vector<QString>& rows, bool bold = false) {
  Drawn result;
  result.image.fill(Qt::red);
  QPainter painter(&result.image);
  QFont font = painter.font();
  font.setBold(bold);
  painter.setFont(font);
  Legend legend(painter, QRectF(result.image.rect()), corner, 150.0, static_cast<int>(rows.size()));
  for (const QString& words : rows) result.samples.push_back(legend.next(words));
  return result;
}

TEST(Legend, HasARowForEachFormInItsCorner) {
  for (const Legend::Corner corner : {Legend::Corner::kLeft, Legend::Corner::kRight}) {
    const Drawn legend = drawn(corner, {"one", "two", "three"});
    ASSERT_EQ(legend.samples.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const QRectF& sample = legend.samples[k];
      EXPECT_TRUE(QRectF(legend.image.rect()).contains(sample)) << k;
      EXPECT_EQ(sample.center().x() < kCanvas.width() / 2.0, corner == Legend::Corner::kLeft) << k;
      if (k > 0) {
        EXPECT_GE(sample.top(), legend.samples[k - 1].bottom()) << k;
      }
      int dark = 0, white = 0;
      for (int x = static_cast<int>(sample.right()) + 1; x < kCanvas.width(); ++x) {
        for (int y = static_cast<int>(sample.top()); y < static_cast<int>(sample.bottom()); ++y) {
          dark += qRed(legend.image.pixel(x, y)) < 120 ? 1 : 0;
          white += qGreen(legend.image.pixel(x, y)) > 150 ? 1 : 0;
        }
      }
      EXPECT_GT(white, 10) << "the words, " << k;
      EXPECT_GT(dark, 500) << "what is behind them, " << k;
    }
  }
}

TEST(Legend, LooksAsItDoesWhateverWasWrittenBefore) {
  EXPECT_EQ(drawn(Legend::Corner::kLeft, {"one"}, true).image, drawn(Legend::Corner::kLeft, {"one"}, false).image);
  EXPECT_NE(drawn(Legend::Corner::kLeft, {"one"}).image, drawn(Legend::Corner::kLeft, {"two"}).image);
}

}  // namespace
}  // namespace laparoscope_servo::screen
