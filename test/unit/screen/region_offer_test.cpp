#include "screen/region_offer.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

const QRect kDrawn(10, 20, 30, 40), kOther(50, 60, 70, 80);

Facts refused() {
  Facts facts;
  facts.drawn = Drawn{kDrawn, 0};
  facts.verdict = Verdict{kDrawn, 0, false, "too smooth", kOther};
  return facts;
}

TEST(RegionOffer, IsTheOneThatWouldDoInPlaceOfTheRefusedOne) {
  const std::optional<Offer> offer = offerOf(refused());
  ASSERT_TRUE(offer);
  EXPECT_EQ(offer->region, kOther);
  EXPECT_EQ(offer->stamp, 0);
  EXPECT_FALSE(offer->not_held);
  Facts facts = refused();
  facts.verdict->proposal = {};
  EXPECT_FALSE(offerOf(facts)) << "none would do";
  facts = refused();
  facts.verdict->region = kOther;
  EXPECT_FALSE(offerOf(facts)) << "an answer about another region";
  facts = refused();
  facts.drawn.reset();
  EXPECT_FALSE(offerOf(facts)) << "it is still being drawn, or a region was taken";
}

TEST(RegionOffer, BelongsToThePictureThatIsShown) {
  Facts facts = refused();
  facts.frozen = Frozen{QImage(), 77, QSize(640, 480), 1.0};
  EXPECT_FALSE(offerOf(facts)) << "it was drawn in the live picture";
  facts.drawn->stamp = facts.verdict->stamp = 77;
  ASSERT_TRUE(offerOf(facts));
  EXPECT_EQ(offerOf(facts)->stamp, 77);
}

TEST(RegionOffer, IsTheTrackersForARegionThatWasNotHeldWhileItIsNotTracked) {
  Facts facts;
  facts.tracker.proposal = kOther;
  facts.tracker.reference_stamp = 5;
  for (const char* state : {"SEARCHING", "LOST"}) {
    facts.tracker.state = state;
    ASSERT_TRUE(offerOf(facts)) << state;
    EXPECT_EQ(offerOf(facts)->region, kOther);
    EXPECT_EQ(offerOf(facts)->stamp, 5);
    EXPECT_TRUE(offerOf(facts)->not_held);
  }
  facts.tracker.state = "NO_IMAGE";
  EXPECT_FALSE(offerOf(facts));
  facts.tracker.state = "LOST";
  facts.frozen = Frozen{QImage(), 77, QSize(640, 480), 1.0};
  EXPECT_FALSE(offerOf(facts)) << "it is of another picture than the frozen one";
}

}  // namespace
}  // namespace laparoscope_servo::screen
