#include "servo/task/parallel/keyed_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/servo/task/parallel/plane_scene.h"

namespace laparoscope_servo::servo {
namespace {

// The scope turns by 30 degrees before tissue at that slant: no error is far from the middle, and what the error does
// from image to image goes on across each change of the key.
TEST(KeyedView, KeepsTheErrorNearTheMiddleAndGoesOn) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(30.0 * kDegree, 0.0);
  KeyedView keyed;
  double last_x = 0.0, last_depth = 0.0, key = 0.0;
  int changes = 0;
  for (int k = 0; k < 130; ++k) {
    const auto seen = keyed.see(0.04 * k, scene.view());
    ASSERT_TRUE(seen) << k;
    const TaskError& of_last = seen->key_changed ? seen->last_key : seen->error;
    if (k > 0) {
      EXPECT_NEAR(of_last.x, last_x, 0.03) << k;
      EXPECT_NEAR(of_last.log_depth, last_depth, 0.01) << k;
    }
    EXPECT_LE(std::abs(seen->error.x), 0.41) << k;
    if (seen->key_changed) {
      ++changes;
      EXPECT_GT(seen->key, key);
      EXPECT_NEAR(seen->error.x, 0.0, 1e-9);
      EXPECT_NEAR(seen->error.log_depth, seen->last_key.log_depth, 1e-9);
    }
    key = seen->key;
    last_x = seen->error.x;
    last_depth = seen->error.log_depth;
    scene.turn(0.004, 0.0);
  }
  EXPECT_GE(changes, 3);
  EXPECT_LE(changes, 8);
}

TEST(KeyedView, TheSameTimeGivesTheSameAgain) {
  PlaneScene scene;
  KeyedView keyed;
  keyed.see(0.0, scene.view());
  scene.turn(0.3, 0.0);
  const auto first = keyed.see(0.04, scene.view());
  const auto again = keyed.see(0.04, scene.view());
  ASSERT_TRUE(first && again);
  EXPECT_TRUE(first->key_changed && again->key_changed);
  EXPECT_EQ(first->key, again->key);
}

TEST(KeyedView, AViewThatNoCameraSeesIsNone) {
  PlaneScene scene;
  KeyedView keyed;
  ASSERT_TRUE(keyed.see(0.0, scene.view()));
  ViewMotion mirrored = scene.view();
  mirrored.h.col(0) *= -1.0;
  EXPECT_FALSE(keyed.see(0.04, mirrored));
  EXPECT_TRUE(keyed.see(0.08, scene.view())) << "it begins anew";
}

}  // namespace
}  // namespace laparoscope_servo::servo
