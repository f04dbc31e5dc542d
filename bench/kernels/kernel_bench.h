// What the benchmarks of the kernels have in common.
//
// Counters: ns_per_px (of processor time) of the ROI (per iteration of ESM where there are any); bytes_per_px and
// flops_per_px are counted from the source (streams of a patch that are read or written once, and arithmetic in which a
// multiply-add is 2), for a roofline; the machine's limits report bytes_per_second and flops_per_second.
#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "bench/support/cpu_clock.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/patch.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::bench {

// Runs the body until Google Benchmark has enough, and counts nanoseconds for each of `pixels`. The body returns how
// many times it went over them.
template <typename Body>
void measure(benchmark::State& state, double pixels, const Body& body) {
  double passes = 0.0;
  const double start = cpuTime();
  for (auto _ : state) passes += body();
  state.counters["ns_per_px"] = 1e9 * (cpuTime() - start) / (passes * pixels);
}

inline void roofline(benchmark::State& state, double bytes, double flops) {
  state.counters["bytes_per_px"] = bytes;
  state.counters["flops_per_px"] = flops;
}

// The sides of the ROI that every kernel is measured on, px.
inline void sides(benchmark::internal::Benchmark* kernel) {
  for (const int side : {100, 196, 400}) kernel->Arg(side);
}

// A square ROI in synthetic tissue, and the same seen a few pixels away, with noise.
struct Scene {
  explicit Scene(const benchmark::State& state);
  double pixels() const { return static_cast<double>(side) * side; }
  cv::Size size() const { return {side, side}; }

  int side;
  geometry::Rectangle roi;
  cv::Mat image, seen;
  Eigen::Matrix3d moved;          // reference to seen
  Eigen::Matrix3d image_T_patch;  // pixels of the ROI to those of the reference image
  image::RegionPyramid reference, current;
};

// The ROI's patches, aligned but for the noise.
struct Patches {
  explicit Patches(const Scene& scene);
  image::Patch reference, reference_gx, reference_gy, warped, valid;
};

}  // namespace laparoscope_servo::bench
