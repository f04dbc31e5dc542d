// Tracking a model does not allocate once it is under way.
#include <gtest/gtest.h>

#include <vector>

#include "laparoscope_servo/model/model_tracker.h"
#include "support/allocation_counter.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

TEST(ModelAllocation, thereIsNoneWhileTracking) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  const auto model = test::modelOf(test::kCubeAndTube);
  const test::ModelScene scene;
  const test::ModelRenderer renderer(*model, scene);
  std::vector<cv::Mat> images;
  for (int k = 0; k < 8; ++k) {
    images.push_back(
        renderer.draw(test::viewOf(*model, 0.5 + 0.003 * k, 0.6 + 0.01 * k), static_cast<unsigned>(k + 1)));
  }
  ModelTracker tracker(model, scene.camera);
  tracker.select(images[0], 0.0, test::viewOf(*model, 0.5));
  for (std::size_t k = 1; k < images.size(); ++k) {
    allocations = 0;
    counting = true;
    const features::State state = tracker.track(images[k], 0.04 * static_cast<double>(k)).state;
    counting = false;
    EXPECT_EQ(state, features::State::kTracking) << "image " << k;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::model
