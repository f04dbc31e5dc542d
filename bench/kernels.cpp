// Nanoseconds per pixel of the core's inner loops, next to what the machine can do at most. Google Benchmark's options
// apply;
// --benchmark_format=json is what report.py reads.
//
// Counters: ns_per_px (of processor time) of the ROI (per iteration of ESM where there are any); bytes_per_px and
// flops_per_px are counted from the source (streams of a patch that are read or written once, and arithmetic in one
// multiply-add = 2), for a roofline; the machine's limits report bytes_per_second and flops_per_second.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "bench/support/cpu_clock.h"
#include "bench/support/synthetic.h"
#include "esm_kernels.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/multiversion.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/image/warp.h"
#include "laparoscope_servo/tracking/esm.h"
#include "laparoscope_servo/tracking/occlusion_gates.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

// Runs the body until Google Benchmark has enough, and counts nanoseconds for each of `pixels`. The body returns how
// many times it went over them.
template <typename Body>
void measure(State& state, double pixels, const Body& body) {
  double passes = 0.0;
  const double start = cpuTime();
  for (auto _ : state) passes += body();
  state.counters["ns_per_px"] = 1e9 * (cpuTime() - start) / (passes * pixels);
}

void roofline(State& state, double bytes, double flops) {
  state.counters["bytes_per_px"] = bytes;
  state.counters["flops_per_px"] = flops;
}

// ---------------------------------------------------------------------------------------------- what the machine can
// do

LAPAROSCOPE_SERVO_CLONES
void triad(float* __restrict a, const float* __restrict b, const float* __restrict c, float s, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
}

LAPAROSCOPE_SERVO_CLONES
void copyFloats(float* __restrict a, const float* __restrict b, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i];
}

// Chains of multiply-adds that do not depend on each other and stay in registers.
constexpr int kChains = 128;  // floats
constexpr int kSteps = 1024;

LAPAROSCOPE_SERVO_CLONES
void multiplyAdd(float* chains, float factor, float summand) {
  typedef float Lanes __attribute__((vector_size(64)));
  Lanes x[kChains / 16];
  const Lanes zero = {};
  const Lanes f = zero + factor;
  const Lanes s = zero + summand;
  __builtin_memcpy(x, chains, sizeof x);
  for (int step = 0; step < kSteps; ++step) {
    x[0] = x[0] * f + s;
    x[1] = x[1] * f + s;
    x[2] = x[2] * f + s;
    x[3] = x[3] * f + s;
    x[4] = x[4] * f + s;
    x[5] = x[5] * f + s;
    x[6] = x[6] * f + s;
    x[7] = x[7] * f + s;
  }
  __builtin_memcpy(chains, x, sizeof x);
}

// Fewer chains, for processors with narrower registers: eight of 32 bytes, and two operands, fit into sixteen.
LAPAROSCOPE_SERVO_CLONES
void multiplyAddNarrow(float* chains, float factor, float summand) {
  typedef float Lanes __attribute__((vector_size(32)));
  Lanes x[10];
  const Lanes zero = {};
  const Lanes f = zero + factor;
  const Lanes s = zero + summand;
  __builtin_memcpy(x, chains, sizeof x);
  for (int step = 0; step < kSteps; ++step) {
    x[0] = x[0] * f + s;
    x[1] = x[1] * f + s;
    x[2] = x[2] * f + s;
    x[3] = x[3] * f + s;
    x[4] = x[4] * f + s;
    x[5] = x[5] * f + s;
    x[6] = x[6] * f + s;
    x[7] = x[7] * f + s;
    x[8] = x[8] * f + s;
    x[9] = x[9] * f + s;
  }
  __builtin_memcpy(chains, x, sizeof x);
}

// range(0): kB that are touched in all.
void machineTriad(State& state) {
  const std::size_t n = static_cast<std::size_t>(state.range(0)) * 1024 / (3 * sizeof(float));
  std::vector<float> a(n, 0.0f), b(n, 1.0f), c(n, 2.0f);
  for (auto _ : state) {
    triad(a.data(), b.data(), c.data(), 0.5f, n);
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * n * 3 * sizeof(float)));
}

void machineCopy(State& state) {
  const std::size_t n = static_cast<std::size_t>(state.range(0)) * 1024 / (2 * sizeof(float));
  std::vector<float> a(n, 0.0f), b(n, 1.0f);
  for (auto _ : state) {
    copyFloats(a.data(), b.data(), n);
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * n * 2 * sizeof(float)));
}

void machineMultiplyAdd(State& state) {
  alignas(64) float chains[kChains] = {};
  float factor = 0.999f, summand = 0.001f;
  benchmark::DoNotOptimize(factor);
  benchmark::DoNotOptimize(summand);
  const bool wide = state.range(0) == 512;
  for (auto _ : state) {
    wide ? multiplyAdd(chains, factor, summand) : multiplyAddNarrow(chains, factor, summand);
    benchmark::DoNotOptimize(chains);
  }
  const double flops = 2.0 * kSteps * (wide ? kChains : 80);
  state.counters["flops_per_second"] = Counter(flops, Counter::kIsIterationInvariantRate);
}

// ------------------------------------------------------------------------------------------------------------- the
// scene

// range(0): side of the ROI.
struct Scene {
  explicit Scene(int s)
      : side(s), roi{(960 - s) / 2.0, (720 - s) / 2.0, static_cast<double>(s), static_cast<double>(s)} {
    image = syntheticTissue(cv::Size(960, 720), 1);
    std::mt19937 random(1);
    moved = displacedCorners(roi, 3.0, random);
    seen = view(image, moved, 2.0, random);
    pyramid.build(seen, cv::Rect(0, 0, seen.cols, seen.rows), 3, image::kLuma);
    reference.build(image, cv::Rect(0, 0, image.cols, image.rows), 3, image::kLuma);
    patch_T_reference.topRightCorner<2, 1>() << roi.x, roi.y;
  }
  double pixels() const { return static_cast<double>(side) * side; }

  int side;
  geometry::Rectangle roi;
  cv::Mat image, seen;
  Eigen::Matrix3d moved;
  Eigen::Matrix3d patch_T_reference = Eigen::Matrix3d::Identity();
  image::RegionPyramid pyramid, reference;
};

void warp(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  image::Patch patch, valid;
  patch.resize(scene.side, scene.side);
  valid.resize(scene.side, scene.side);
  const Eigen::Matrix3d g = scene.moved * scene.patch_T_reference;
  measure(state, scene.pixels(), [&] {
    benchmark::DoNotOptimize(image::warpBilinear(scene.pyramid.level(0), g, patch, valid));
    return 1;
  });
  roofline(state, 4 + 4 + 4, 8 + 9);  // image, patch, validity; the point with two divisions, three interpolations
}

image::Lens lensOf(image::Distortion distortion) {
  image::LensParameters parameters;
  const std::array<double, 8> coefficients[] = {{-0.38, 0.16, 0.0008, -0.0006, -0.02},
                                                {0.35, -0.05, 0.0005, -0.0004, 0.004, 0.72, 0.06, 0.002},
                                                {-0.02, 0.006, -0.003, 0.0005}};
  parameters.distortion = distortion;
  parameters.coefficients = coefficients[static_cast<int>(distortion)];
  parameters.raw = parameters.rectified = {700.0, 700.0, 480.0, 360.0};
  return image::Lens(parameters);
}

void warpThroughLens(State& state, image::Distortion distortion) {
  const Scene scene(static_cast<int>(state.range(0)));
  const image::Lens lens = lensOf(distortion);
  image::Patch patch, valid;
  patch.resize(scene.side, scene.side);
  valid.resize(scene.side, scene.side);
  const Eigen::Matrix3d g = scene.moved * scene.patch_T_reference;
  measure(state, scene.pixels(), [&] {
    benchmark::DoNotOptimize(image::warpBilinear(scene.pyramid.level(0), g, lens, {}, patch, valid));
    return 1;
  });
  roofline(state, 4 + 4 + 4, 35 + 9);  // as above; the point with two divisions and the polynomials
}

// What taking the lens out of the whole image costs: image_proc's way, fixed-point maps that are made once. range(0),
// range(1): px.
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

void gradients(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  image::Patch patch, valid, gx, gy;
  patch.resize(scene.side, scene.side);
  valid.resize(scene.side, scene.side);
  image::warpBilinear(scene.pyramid.level(0), scene.patch_T_reference, patch, valid);
  measure(state, scene.pixels(), [&] {
    image::gradients(patch, gx, gy);
    benchmark::ClobberMemory();
    return 1;
  });
  roofline(state, 3 * 4, 4);
}

void pyramid(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
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

void sums(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  tracking::EsmConfig config;
  tracking::Esm esm(config);
  esm.setReference(scene.reference, scene.roi);
  esm.align(scene.pyramid, tracking::EsmState());
  const tracking::EsmLevel& level = esm.level(0);
  image::Patch warped = level.warped;
  tracking::CellInput input;
  input.image = &warped;
  input.reference = &level.value;
  input.reference_gx = &level.gx;
  input.reference_gy = &level.gy;
  input.weight = &level.weight;
  input.inverse_rejection = 1.0f / 20.0f;
  const std::vector<float> bias(warped.strips(), 0.0f);
  std::vector<tracking::CellSums> cells(warped.strips());
  measure(state, scene.pixels(), [&] {
    for (int row = 0; row < scene.side; row += tracking::kMaxCellRows) {
      tracking::sumCells(input, row, std::min(tracking::kMaxCellRows, scene.side - row), 1, bias.data(), cells.data());
      benchmark::DoNotOptimize(cells.data());
    }
    return 1;
  });
  roofline(state, 5 * 4,
           20 + 24);  // image, reference, its gradients, weight; residual, weight, gradients; fourteen sums
}

void colourGate(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  tracking::OcclusionGates gates{tracking::OcclusionConfig(), tracking::EsmConfig().saturation};
  const cv::Size size(scene.side, scene.side);
  image::ColourPatch patch;
  image::warpNearest(scene.image, scene.patch_T_reference, size, patch);
  gates.setReference(patch);
  measure(state, scene.pixels(), [&] {
    image::warpNearest(scene.seen, scene.moved * scene.patch_T_reference, size, patch);
    gates.observeColour(patch);
    benchmark::DoNotOptimize(gates.weights().data);
    return 1;
  });
  roofline(state, 3 + 3 + 1 + 4,
           8 + 20);  // image, patch, mask, weights; the point, and the feature with a root and a division
}

void structureGate(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  tracking::Esm esm{tracking::EsmConfig()};
  esm.setReference(scene.reference, scene.roi);
  const tracking::EsmResult result = esm.align(scene.pyramid, tracking::EsmState());
  const image::AreaGrid grid(scene.side, scene.side, 14, 14);
  const tracking::EsmLevel& level = esm.level(0);
  tracking::StructureStatistics statistics;
  measure(state, scene.pixels(), [&] {
    statistics.compute(level.warped, level.value, level.valid, grid);
    for (int k = 0; k < statistics.count(); ++k) {
      benchmark::DoNotOptimize(statistics.dissimilarity(k, result.state.gain, result.sigma));
    }
    return 1;
  });
  roofline(state, 3 * 4, 14);
}

// Every iteration of ESM at the finest level: warp, scale of the residual, sums, solution.
void esmIteration(State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  tracking::EsmConfig config;
  config.min_step = 0.0001;
  tracking::Esm esm(config);
  esm.setReference(scene.reference, scene.roi);
  double iterations = 0.0;
  measure(state, scene.pixels(), [&] {
    const int done = esm.align(scene.pyramid, tracking::EsmState(), 0, 0).iterations;
    iterations += done;
    return done;
  });
  state.counters["iterations"] = Counter(iterations, Counter::kAvgIterations);
  roofline(state, 12 + 20, 17 + 44);  // warp and sums
}

// Everything, image by image, over a motion there and back.
void track(State& state, bool through_lens) {
  const Scene scene(static_cast<int>(state.range(0)));
  std::mt19937 random(2);
  std::vector<cv::Mat> images;
  constexpr int kImages = 24;
  for (int k = 0; k < kImages; ++k) {
    const double phase = 2.0 * 3.14159265358979 * k / kImages;
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topRightCorner<2, 1>() << 12.0 * std::sin(phase), 8.0 * (std::cos(phase) - 1.0);
    g(2, 0) = 5e-5 * std::sin(phase);
    images.push_back(view(scene.image, g, 2.0, random));
  }
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  if (through_lens) {
    // The images are raw ones, and no plane any more: little enough that the tracker does not mind, and the work is the
    // same.
    image::LensParameters parameters;
    parameters.coefficients = {-0.01, 0.001, 0.0, 0.0, 0.0};
    parameters.raw = parameters.rectified = {700.0, 700.0, 480.0, 360.0};
    tracker.setLens(image::Lens(parameters));
  }
  tracker.select(images[0], 0.0, scene.roi);
  double iterations = 0.0, stamp = 0.0, tracked = 0.0;
  std::size_t k = 0;
  measure(state, scene.pixels(), [&] {
    k = (k + 1) % kImages;
    stamp += 0.04;
    const tracking::TrackResult result = tracker.track(images[k], stamp);
    iterations += result.iterations;
    tracked += result.state == tracking::State::kTracking ? 1.0 : 0.0;
    return 1;
  });
  state.counters["iterations"] = Counter(iterations, Counter::kAvgIterations);
  state.counters["tracked"] = Counter(tracked, Counter::kAvgIterations);
}

// Within L1, L2 (twice), L3, and from memory, as most processors are.
BENCHMARK(machineCopy)->Name("machine/copy")->Arg(16)->Arg(200)->Arg(700)->Arg(6000)->Arg(131072);
BENCHMARK(machineTriad)->Name("machine/triad")->Arg(16)->Arg(200)->Arg(700)->Arg(6000)->Arg(131072);
BENCHMARK(machineMultiplyAdd)->Name("machine/multiply_add")->Arg(256)->Arg(512);
BENCHMARK(warp)->Name("kernel/warp")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK_CAPTURE(warpThroughLens, plumb_bob, image::Distortion::kPlumbBob)
    ->Name("kernel/warp_plumb_bob")
    ->Arg(100)
    ->Arg(196)
    ->Arg(400);
BENCHMARK_CAPTURE(warpThroughLens, rational, image::Distortion::kRationalPolynomial)
    ->Name("kernel/warp_rational_polynomial")
    ->Arg(196);
BENCHMARK_CAPTURE(warpThroughLens, equidistant, image::Distortion::kEquidistant)
    ->Name("kernel/warp_equidistant")
    ->Arg(100)
    ->Arg(196)
    ->Arg(400);
BENCHMARK(gradients)->Name("kernel/gradients")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK(sums)->Name("kernel/sums")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK(pyramid)->Name("kernel/pyramid")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK(colourGate)->Name("kernel/colour_gate")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK(structureGate)->Name("kernel/structure_gate")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK(esmIteration)->Name("kernel/esm_iteration")->Arg(100)->Arg(196)->Arg(400);
BENCHMARK_CAPTURE(track, plain, false)
    ->Name("kernel/track")
    ->Arg(100)
    ->Arg(196)
    ->Arg(400)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, lens, true)
    ->Name("kernel/track_through_lens")
    ->Arg(100)
    ->Arg(196)
    ->Arg(400)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(remapImage)->Name("peer/remap_image")->Args({640, 480})->Args({1920, 1080})->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
