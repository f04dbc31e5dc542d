// The gates of occlusion, and the whole tracker.
#include <cmath>
#include <random>
#include <vector>

#include "bench/kernels/kernel_bench.h"
#include "bench/support/synthetic.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "tracking/occlusion/occlusion_gates.h"

namespace laparoscope_servo::bench {

namespace {

using benchmark::State;

constexpr double kPi = 3.14159265358979;

struct Gates {
  explicit Gates(const Scene& scene)
      : step(tracking::samplingStep(scene.size(), tracking::OcclusionConfig())),
        gates(tracking::OcclusionConfig(), tracking::EsmConfig().saturation) {
    sample(scene.image, scene.image_T_patch, scene.size());
    gates.setReference(patch, scene.size());
  }
  void sample(const cv::Mat& image, const Eigen::Matrix3d& image_T_patch, const cv::Size& size) {
    Eigen::Matrix3d image_T_sample = image_T_patch;
    image_T_sample.leftCols<2>() *= step;
    const cv::Size samples((size.width + step - 1) / step, (size.height + step - 1) / step);
    image::warpNearest(image, image_T_sample, samples, patch);
  }
  int step;
  tracking::OcclusionGates gates;
  image::ColourPatch patch;
};

void colourGate(State& state) {
  const Scene scene(state);
  Gates g(scene);
  measure(state, scene.pixels(), [&] {
    g.sample(scene.seen, scene.moved * scene.image_T_patch, scene.size());
    g.gates.observeColour(g.patch);
    benchmark::DoNotOptimize(g.gates.weights().row(0));
    return 1;
  });
  // Of each sample image, patch, validity and mask; of each pixel what is usable, and its weight. The sample's point,
  // its feature with a root and three divisions and the bin of that; the pixel's weight.
  const double samples = 1.0 / (g.step * g.step);
  roofline(state, samples * (3 + 3 + 1 + 1) + 4 + 4, samples * (11 + 24) + 1);
}

void structureGate(State& state) {
  const Scene scene(state);
  const Patches patches(scene);
  const tracking::PatchPair pair = {&patches.warped, &patches.reference};
  Gates g(scene);
  measure(state, scene.pixels(), [&] {
    const int found = g.gates.observeStructure(&pair, 1, patches.valid, 1.0, 2.0);
    benchmark::DoNotOptimize(found);
    return 1;
  });
  // Image, reference, what is valid, what is usable, what is both; that product, two weighted values, six sums.
  roofline(state, 5 * 4, 1 + 2 + 9);
}

// Image by image, over a motion there and back.
void track(State& state, bool through_lens) {
  const Scene scene(state);
  std::mt19937 random(2);
  std::vector<cv::Mat> images;
  constexpr int kImages = 24;
  for (int k = 0; k < kImages; ++k) {
    const double phase = 2.0 * kPi * k / kImages;
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topRightCorner<2, 1>() << 12.0 * std::sin(phase), 8.0 * (std::cos(phase) - 1.0);
    g(2, 0) = 5e-5 * std::sin(phase);
    images.push_back(view(scene.image, g, 2.0, random));
  }
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  if (through_lens) {
    // The images are raw ones then, and show no plane any more: by little enough that the work is the same.
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
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["tracked"] = benchmark::Counter(tracked, benchmark::Counter::kAvgIterations);
}

BENCHMARK(colourGate)->Name("kernel/colour_gate")->Apply(sides);
BENCHMARK(structureGate)->Name("kernel/structure_gate")->Apply(sides);
BENCHMARK_CAPTURE(track, plain, false)->Name("kernel/track")->Apply(sides)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, lens, true)->Name("kernel/track_through_lens")->Apply(sides)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace laparoscope_servo::bench
