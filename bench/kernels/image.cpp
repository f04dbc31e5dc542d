// The image part: pyramid, warp, gradients.
#include "bench/kernels/kernel_bench.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::bench {

namespace {

using benchmark::State;

void pyramid(State& state) {
  const Scene scene(state);
  const int margin = scene.side / 4;
  const cv::Rect region(static_cast<int>(scene.roi.x) - margin, static_cast<int>(scene.roi.y) - margin,
                        scene.side + 2 * margin, scene.side + 2 * margin);
  image::RegionPyramid built;
  measure(state, region.area(), [&] {
    built.build(scene.seen, region, 3, image::kLuma);
    benchmark::ClobberMemory();
    return 1;
  });
  // Colour in, grey out and in again, coarser levels; the weights, and a 5 x 5 filter, separable, on a quarter.
  roofline(state, 3 + 4 + 1.25 * 4 + 1.3, 5 + 1.3 * 0.75 * 10);
}

void warp(State& state) {
  const Scene scene(state);
  Patches patches(scene);
  const Eigen::Matrix3d g = scene.moved * scene.image_T_patch;
  measure(state, scene.pixels(), [&] {
    benchmark::DoNotOptimize(image::warpBilinear(scene.current.level(0), g, patches.warped, patches.valid));
    return 1;
  });
  roofline(state, 4 + 4 + 4, 8 + 9);  // image, patch, validity; the point with two divisions, three interpolations
}

void gradients(State& state) {
  const Scene scene(state);
  Patches patches(scene);
  measure(state, scene.pixels(), [&] {
    image::gradients(patches.reference, patches.reference_gx, patches.reference_gy);
    benchmark::ClobberMemory();
    return 1;
  });
  roofline(state, 3 * 4, 4);
}

BENCHMARK(pyramid)->Name("kernel/pyramid")->Apply(sides);
BENCHMARK(warp)->Name("kernel/warp")->Apply(sides);
BENCHMARK(gradients)->Name("kernel/gradients")->Apply(sides);

}  // namespace

}  // namespace laparoscope_servo::bench
