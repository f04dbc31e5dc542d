// The image part: pyramid and warp.
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
  // Colour in, one channel out; two levels in again, each a quarter of that out. The channels' weights, three pixels
  // along and across; for each level 1 4 6 4 1 across every second row, and along that for every second pixel.
  roofline(state, 3 + 4 + (1 + 0.25) * (4 + 1), 5 + 2 * 4 + (1 + 0.25) * (7.0 / 2 + 6.0 / 4));
}

void warp(State& state) {
  const Scene scene(state);
  Patches patches(scene);
  const Eigen::Matrix3d g = scene.moved * scene.image_T_patch;
  measure(state, scene.pixels(), [&] {
    benchmark::DoNotOptimize(image::warpBilinear(scene.current.level(0), g, patches.warped, patches.valid));
    return 1;
  });
  // Image, patch, validity; the point with one division, its place between pixels, three interpolations.
  roofline(state, 4 + 4 + 4, 9 + 2 + 9);
}

BENCHMARK(pyramid)->Name("kernel/pyramid")->Apply(sides);
BENCHMARK(warp)->Name("kernel/warp")->Apply(sides);

}  // namespace

}  // namespace laparoscope_servo::bench
