#include "tracking/search/search_budget.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

TEST(SearchBudget, PaysWhatFits) {
  SearchBudget budget;
  budget.start(10.0);
  EXPECT_TRUE(budget.pay(6.0));
  EXPECT_FALSE(budget.pay(5.0));
  EXPECT_TRUE(budget.pay(4.0));
  EXPECT_FALSE(budget.pay(0.1));
  budget.start(10.0);
  EXPECT_TRUE(budget.pay(6.0));
}

TEST(SearchBudget, TheFirstPieceIsDoneWhateverItCosts) {
  SearchBudget budget;
  budget.start(1.0);
  EXPECT_TRUE(budget.pay(50.0));
  EXPECT_FALSE(budget.pay(0.001));
  EXPECT_FALSE(budget.payCheap(0.001));
}

TEST(SearchBudget, ATrifleIsPaidButIsNotTheFirstPiece) {
  SearchBudget budget;
  budget.start(1.0);
  EXPECT_TRUE(budget.payCheap(0.75));
  EXPECT_FALSE(budget.payCheap(0.5));
  EXPECT_TRUE(budget.pay(0.5));
  EXPECT_FALSE(budget.pay(0.5));
}

TEST(SearchBudget, TheFirstTrifleIsDoneWhateverItCostsAndSoIsThePieceAfterIt) {
  SearchBudget budget;
  budget.start(1.0);
  EXPECT_TRUE(budget.payCheap(3.0));
  EXPECT_FALSE(budget.payCheap(0.001));
  EXPECT_TRUE(budget.pay(50.0));
  EXPECT_FALSE(budget.pay(0.001));
}

// Else an image would take all trifles and a whole piece. It is the first of the next image, so that it gets done.
TEST(SearchBudget, TriflesThatTookMoreThanHalfLeaveAnExpensivePieceToTheNextImage) {
  SearchBudget budget;
  budget.start(1.0);
  EXPECT_TRUE(budget.payCheap(0.25));
  EXPECT_TRUE(budget.payCheap(0.5));
  EXPECT_FALSE(budget.pay(0.5));
  EXPECT_TRUE(budget.pay(0.25));
  budget.start(1.0);
  EXPECT_TRUE(budget.payCheap(0.25));
  EXPECT_TRUE(budget.payCheap(0.25));
  EXPECT_TRUE(budget.pay(50.0));
}

TEST(SearchBudget, WhatCostMoreLeavesLess) {
  SearchBudget budget;
  budget.start(1.0);
  EXPECT_TRUE(budget.pay(0.25));
  budget.charge(0.5);
  EXPECT_EQ(budget.left(), 0.25);
  EXPECT_FALSE(budget.pay(0.5));
  budget.charge(-0.5);
  EXPECT_TRUE(budget.pay(0.5));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
