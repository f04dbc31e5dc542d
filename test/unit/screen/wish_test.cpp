#include "screen/wish.h"

#include <gtest/gtest.h>

#include <optional>

namespace laparoscope_servo::screen {
namespace {

TEST(Wish, HoldsUntilItIsEnded) {
  Wish wish;
  const Wish::Holds first = wish.present(), again = wish.present();
  EXPECT_TRUE(first() && again());
  wish.end();
  EXPECT_FALSE(first() || again());
  const Wish::Holds second = wish.present();
  EXPECT_TRUE(second());
  EXPECT_FALSE(first()) << "an earlier one does not come back";
}

TEST(Wish, IsOutlivedByItsChecks) {
  std::optional<Wish> wish{Wish()};
  const Wish::Holds holds = wish->present();
  wish.reset();
  EXPECT_TRUE(holds());
}

}  // namespace
}  // namespace laparoscope_servo::screen
