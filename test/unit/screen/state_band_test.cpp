#include "screen/state_band.h"

#include <gtest/gtest.h>

#include <QImage>
#include <string>
#include <vector>

namespace laparoscope_servo::screen {
namespace {

BandText tracking() {
  return {"TRACKING", "The region is followed.", "", "", Level::kGood};
}

QImage drawn(StateBand& band, const QSize& size) {
  band.resize(size);
  QImage image(size, QImage::Format_RGB32);
  image.fill(QColor(200, 60, 60));  // tissue
  band.render(&image);
  return image;
}

// Rows from the first to the last that have a white pixel right of the stripe, above the sentence.
int heightOfWord(const QImage& image) {
  int first = -1, last = -1;
  for (int y = 16; y < 72; ++y) {
    for (int x = 60; x < image.width() - 4; ++x) {
      if (image.pixel(x, y) != qRgb(255, 255, 255)) continue;
      if (first < 0) first = y;
      last = y;
      break;
    }
  }
  return first < 0 ? 0 : last - first + 1;
}

TEST(StateBand, ItsWordIsReadFromAfar) {
  StateBand band("Tracker", nullptr);
  for (const char* word : {"TRACKING", "SEARCHING", "NOT STARTED", "NO MASTER", "IDLE"}) {
    BandText text = tracking();
    text.word = word;
    band.show(text);
    EXPECT_GE(heightOfWord(drawn(band, {400, band.sizeHint().height()})), 40) << word;
  }
}

TEST(StateBand, CoversWhatIsBelowIt) {
  StateBand band("Tracker", nullptr);
  band.show(tracking());
  const QImage image = drawn(band, {400, 160});
  for (int y = 0; y < 160; y += 7) {
    for (int x = 0; x < 400; x += 7) EXPECT_NE(image.pixel(x, y), qRgb(200, 60, 60));
  }
}

TEST(StateBand, ALongReasonDoesNotChangeItsSize) {
  StateBand band("Tracker", nullptr);
  band.show(tracking());
  const QSize before = band.sizeHint();
  BandText text = tracking();
  text.sentence = std::string(2000, 'w');
  text.cure = std::string(500, ' ') + "<h1>x</h1>";
  text.detail = "<script>";
  band.show(text);
  EXPECT_EQ(band.sizeHint(), before);
  EXPECT_EQ(band.minimumSizeHint(), before);
  EXPECT_EQ(band.toolTip(), "&lt;script&gt;");
  drawn(band, {400, 160});
}

TEST(StateBand, LevelsDifferInFormNotOnlyInColour) {
  StateBand band("Tracker", nullptr);
  std::vector<QImage> symbols;
  for (const Level level : {Level::kUnknown, Level::kResting, Level::kGood, Level::kWaiting, Level::kBad}) {
    BandText text = tracking();
    text.level = level;
    band.show(text);
    QImage stripe = drawn(band, {400, 160}).copy(0, 14, 44, 56);
    const QRgb background = stripe.pixel(1, 1);
    for (int y = 0; y < stripe.height(); ++y) {  // the colour taken out
      for (int x = 0; x < stripe.width(); ++x) stripe.setPixel(x, y, stripe.pixel(x, y) == background ? 0 : 1);
    }
    for (const QImage& other : symbols) EXPECT_NE(other, stripe);
    symbols.push_back(stripe);
  }
}

}  // namespace
}  // namespace laparoscope_servo::screen
