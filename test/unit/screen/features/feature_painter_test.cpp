#include "screen/features/feature_painter.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/TrackedFeatures.h>

#include <limits>

#include "support/like_colour.h"
#include "unit/screen/features/feature_facts_examples.h"

namespace laparoscope_servo::screen {
namespace {

using test_support::featuresMessage;
using test_support::lineMessage;
using test_support::pointMessage;

const QSize kImage(400, 240);
constexpr double kStamp = 500.0;

// What is drawn over a picture of kStamp, on a widget twice as large as the image.
QImage drawn(const std::vector<TrackedFeature>& features, double stamp = kStamp,
             const std::optional<QPointF>& mouse = std::nullopt) {
  Facts facts;
  facts.picture.stamp = static_cast<std::int64_t>(kStamp * 1e9);
  facts.features.resize(1);
  facts.features[0].name = "edges";
  facts.features[0].drawn = featureResult(featuresMessage(stamp, features));
  QImage image(2 * kImage, QImage::Format_RGB32);
  image.fill(QColor(180, 70, 60));
  QPainter painter(&image);
  drawFeatures(painter, facts, Letterbox(kImage, QRectF(image.rect())), mouse);
  return image;
}

// Pixels of about this colour in a rectangle of the original image.
int count(const QImage& image, const QRectF& where, const QColor& colour) {
  int found = 0;
  const QRect box = QRectF(2 * where.topLeft(), 2 * where.size()).toRect() & image.rect();
  for (int y = box.top(); y <= box.bottom(); ++y) {
    for (int x = box.left(); x <= box.right(); ++x) {
      if (laparoscope_servo::test_support::isLike(image.pixelColor(x, y), colour)) ++found;
    }
  }
  return found;
}

const QRectF kOnLine(160, 59, 60, 3);  // away from its ends and its name

TEST(FeaturePainter, DrawsALineWhereItIs) {
  const QImage image = drawn({lineMessage()});
  EXPECT_GT(count(image, kOnLine, kFeatureColour), 200) << "solid: two rows of 120 px of the widget";
  EXPECT_EQ(count(image, {160, 20, 60, 20}, kFeatureColour), 0);
}

// By its form, too, not by its colour alone.
TEST(FeaturePainter, WhatIsSearchedIsDottedAndWhatIsLostIsAway) {
  TrackedFeature line = lineMessage();
  line.covariance.assign(4, std::numeric_limits<double>::infinity());
  const int solid = count(drawn({line}), kOnLine, kFeatureColour);
  line.state = TrackedFeatures::SEARCHING;
  const int dotted = count(drawn({line}), kOnLine, kFeatureColour);
  EXPECT_GT(dotted, solid / 5);
  EXPECT_LT(dotted, 4 * solid / 5);
  line.state = TrackedFeatures::LOST;
  EXPECT_EQ(drawn({line}), drawn({}));
}

TEST(FeaturePainter, ShowsTheExpectedErrorAsABandAndAsAnEllipse) {
  TrackedFeature line = lineMessage();  // 4 px, so that the band is 8 px to either side
  const QColor edge = kFeatureColour;
  EXPECT_GT(count(drawn({line}), {160, 51, 60, 2}, edge), 50) << "above";
  EXPECT_GT(count(drawn({line}), {160, 67, 60, 2}, edge), 50) << "below";
  line.covariance = {1e-4, 0.0, 0.0, 0.0};
  EXPECT_EQ(count(drawn({line}), {160, 45, 60, 13}, edge), 0) << "it would be hidden by the line";
  // 5 px across, 10 px down; twice that.
  const QImage point = drawn({pointMessage("tip", 200.0, 120.0)});
  EXPECT_GT(count(point, {208, 115, 4, 10}, edge), 5) << "right";
  EXPECT_GT(count(point, {195, 138, 10, 4}, edge), 5) << "below";
  EXPECT_EQ(count(point, {216, 122, 10, 16}, edge), 0) << "further right";
}

TEST(FeaturePainter, EachKindHasAFormOfItsOwn) {
  std::vector<QImage> forms;
  for (const int kind : {TrackedFeature::LINE, TrackedFeature::SPLINE, TrackedFeature::POSE}) {
    TrackedFeature feature = lineMessage("");
    feature.kind = static_cast<std::uint8_t>(kind);
    feature.covariance.clear();
    feature.expected_error = 0.0;
    const QImage grey = drawn({feature}).convertToFormat(QImage::Format_Grayscale8);
    EXPECT_NE(grey, drawn({}).convertToFormat(QImage::Format_Grayscale8));
    for (const QImage& other : forms) EXPECT_NE(grey, other);
    forms.push_back(grey);
  }
  // Points of an object's edges are no line.
  TrackedFeature object = lineMessage("");
  object.kind = TrackedFeature::POSE;
  object.outline = {100.0, 60.0, 200.0, 160.0, 300.0, 60.0};
  const QImage image = drawn({object});
  EXPECT_GT(count(image, {198, 158, 5, 5}, kFeatureColour), 5);
  EXPECT_EQ(count(image, {140, 100, 20, 20}, kFeatureColour), 0);
}

TEST(FeaturePainter, OfManyOnlyTheOneAtTheMouseHasItsName) {
  std::vector<TrackedFeature> points;
  for (std::size_t k = 0; k <= kFewFeatures; ++k) points.push_back(pointMessage("point", 30.0 + 40.0 * k, 120.0));
  const auto named = [](const QImage& image, double u) {  // the dark box behind the name, at the right of its point
    return count(image, {u + 5, 112, 10, 3}, QColor(60, 23, 20)) > 5;
  };
  const std::vector<TrackedFeature> few(points.begin(), points.end() - 1);
  EXPECT_TRUE(named(drawn(few), 30.0));
  EXPECT_TRUE(named(drawn(few), 70.0));
  EXPECT_FALSE(named(drawn(points), 30.0));
  EXPECT_FALSE(named(drawn(points), 70.0));
  const QImage at_mouse = drawn(points, kStamp, QPointF(2 * 70.0 + 8.0, 2 * 120.0));
  EXPECT_TRUE(named(at_mouse, 70.0));
  EXPECT_FALSE(named(at_mouse, 30.0));
  EXPECT_FALSE(named(drawn(points, kStamp, QPointF(2 * 70.0, 2 * 60.0)), 70.0)) << "too far away";
}

TEST(FeaturePainter, WhatIsOfAnEarlierPictureIsGreyWithItsAge) {
  const QImage now = drawn({lineMessage()}), before = drawn({lineMessage()}, kStamp - 0.04);
  EXPECT_EQ(count(before, kOnLine, kFeatureColour), 0);
  EXPECT_GT(count(before, kOnLine, kOldFeatureColour), 200);
  const QRectF words(203, 53, 60, 9);
  const QImage old = drawn({lineMessage()}, kStamp - 0.5);
  EXPECT_EQ(count(before, words, Qt::white), 0) << "a picture or two need no words";
  EXPECT_GT(count(old, words, Qt::white), 20);
  EXPECT_NE(old, drawn({lineMessage()}, kStamp - 0.7)) << "the words tell the age";
  EXPECT_EQ(drawn({lineMessage()}, kStamp - 60.0), drawn({})) << "of long ago";
}

TEST(FeaturePainter, DrawsNothingThatIsNowhere) {
  TrackedFeature line = lineMessage();
  line.outline[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drawn({line}), drawn({}));
  line.outline = {50.0, 50.0, 50.0, 50.0};  // without length
  line.covariance[3] = 1e12;
  drawn({line});
  Facts facts;
  facts.features.resize(2);
  QImage image(10, 10, QImage::Format_RGB32);
  QPainter painter(&image);
  drawFeatures(painter, facts, Letterbox());
  drawFeatures(painter, facts, Letterbox({5, 5}, QRectF(0, 0, 10, 10)));
}

TEST(FeaturePainter, TheLegendHasEachFormAndNoPlaceInASmallPicture) {
  for (const auto& [size, shown] : {std::pair(QSize(800, 500), true), {QSize(400, 300), false}}) {
    QImage image(size, QImage::Format_RGB32);
    image.fill(QColor(180, 70, 60));
    const QImage before = image;
    {
      QPainter painter(&image);
      drawFeatureLegend(painter, QRectF(image.rect()));
    }
    EXPECT_EQ(image != before, shown);
    if (!shown) continue;
    EXPECT_EQ(image.copy(0, 0, 500, 500), before.copy(0, 0, 500, 500)) << "the region's legend stays readable";
    for (int row = 0; row < 6; ++row) {
      const QRectF sample((800 - 240 + 8) / 2.0, (500 - 108 + 4 + 16 * row) / 2.0, 17, 8);
      EXPECT_GT(count(image, sample, row == 5 ? kOldFeatureColour : kFeatureColour), 10) << row;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::screen
