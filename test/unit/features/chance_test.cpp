#include "features/chance.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::features {
namespace {

Agreement agreement(int sites, double share, double strays) {
  Agreement a;
  a.sites = sites;
  a.agree = static_cast<int>(share * sites);
  a.strays = strays;
  return a;
}

TEST(Chance, whatNearlyAllSitesShowIsNone) {
  EXPECT_TRUE(isNoChance(agreement(50, 0.9, 1.0)));
  EXPECT_TRUE(isNoChance(agreement(50, 0.9, 0.0)));
}

TEST(Chance, asManyAsStraysGiveIsNothing) {
  for (const double strays : {0.5, 2.0, 6.0}) {
    EXPECT_FALSE(isNoChance(agreement(200, strays / 20.0, strays)));
    EXPECT_FALSE(isNoChance(agreement(200, 0.5 * strays / 20.0, strays)));
  }
}

TEST(Chance, fewSitesProveLess) {
  EXPECT_TRUE(isNoChance(agreement(100, 0.4, 1.0)));
  EXPECT_FALSE(isNoChance(agreement(10, 0.4, 1.0)));
  EXPECT_FALSE(isNoChance(agreement(0, 0.0, 1.0)));
  Agreement alike = agreement(100, 0.4, 1.0);
  alike.independent = 0.1;
  EXPECT_FALSE(isNoChance(alike));
}

TEST(Chance, aWiderSearchAndMoreFreedomsProveLess) {
  Agreement few = agreement(40, 0.45, 2.0), many = few;
  many.freedoms = 4;
  EXPECT_TRUE(isNoChance(few));
  EXPECT_FALSE(isNoChance(many));
}

}  // namespace
}  // namespace laparoscope_servo::features
