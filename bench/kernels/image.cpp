// The image part: pyramid and warp.
#include <array>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "bench/kernels/kernel_bench.h"
#include "bench/support/synthetic.h"
#include "laparoscope_servo/image/lens.h"
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

image::Lens lensOf(image::Distortion distortion) {
  const std::array<double, 8> coefficients[] = {{-0.38, 0.16, 0.0008, -0.0006, -0.02},
                                                {0.35, -0.05, 0.0005, -0.0004, 0.004, 0.72, 0.06, 0.002},
                                                {-0.02, 0.006, -0.003, 0.0005}};
  image::LensParameters parameters;
  parameters.distortion = distortion;
  parameters.coefficients = coefficients[static_cast<int>(distortion)];
  parameters.raw = parameters.rectified = {700.0, 700.0, 480.0, 360.0};
  return image::Lens(parameters);
}

void warpThroughLens(State& state, image::Distortion distortion) {
  const Scene scene(state);
  Patches patches(scene);
  const image::Lens lens = lensOf(distortion);
  const image::RawWindow window{scene.current.origin(), 1.0};
  const Eigen::Matrix3d g = scene.moved * scene.image_T_patch;
  measure(state, scene.pixels(), [&] {
    benchmark::DoNotOptimize(
        image::warpBilinear(scene.current.level(0), g, lens, window, patches.warped, patches.valid));
    return 1;
  });
  roofline(state, 4 + 4 + 4, 35 + 9);  // as above; the point with two divisions and the polynomials
}

// What taking the lens out of the whole image costs: image_proc's way, by fixed-point maps that are made once.
// Arguments: px.
void remapImage(State& state) {
  const cv::Size size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const cv::Mat image = syntheticTissue(size, 1);
  const double f = 0.73 * size.width;
  const cv::Matx33d k(f, 0.0, 0.5 * size.width, 0.0, f, 0.5 * size.height, 0.0, 0.0, 1.0);
  cv::Mat map, interpolation, rectified;
  cv::initUndistortRectifyMap(k, std::vector<double>{-0.38, 0.16, 0.0008, -0.0006, -0.02}, cv::noArray(), k, size,
                              CV_16SC2, map, interpolation);
  measure(state, size.area(), [&] {
    cv::remap(image, rectified, map, interpolation, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    benchmark::ClobberMemory();
    return 1;
  });
}

BENCHMARK(pyramid)->Name("kernel/pyramid")->Apply(sides);
BENCHMARK(warp)->Name("kernel/warp")->Apply(sides);
BENCHMARK_CAPTURE(warpThroughLens, plumb_bob, image::Distortion::kPlumbBob)
    ->Name("kernel/warp_plumb_bob")
    ->Apply(sides);
BENCHMARK_CAPTURE(warpThroughLens, rational, image::Distortion::kRationalPolynomial)
    ->Name("kernel/warp_rational_polynomial")
    ->Apply(sides);
BENCHMARK_CAPTURE(warpThroughLens, equidistant, image::Distortion::kEquidistant)
    ->Name("kernel/warp_equidistant")
    ->Apply(sides);
BENCHMARK(remapImage)->Name("peer/remap_image")->Args({640, 480})->Args({1920, 1080})->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace laparoscope_servo::bench
