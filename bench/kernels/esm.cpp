// ESM: the sums of its normal equations, and a whole iteration.
#include "tracking/esm/esm.h"

#include <algorithm>
#include <vector>

#include "bench/kernels/kernel_bench.h"
#include "tracking/esm/esm_kernels.h"  // private to the tracking part

namespace laparoscope_servo::bench {

namespace {

using benchmark::State;

void sums(State& state) {
  const Scene scene(state);
  const Patches patches(scene);
  image::Patch weight;
  weight.resize(scene.side, scene.side);
  weight.view().setTo(1.0f);
  tracking::CellInput input;
  input.image = &patches.warped;
  input.reference = &patches.reference;
  input.weight = &weight;
  input.inverse_rejection = 1.0f / 20.0f;
  const std::vector<float> bias(static_cast<std::size_t>(weight.strips()), 0.0f);
  std::vector<tracking::CellSums> cells(bias.size());
  measure(state, scene.pixels(), [&] {
    for (int row = 0; row < scene.side; row += tracking::kMaxCellRows) {
      tracking::sumCells(input, row, std::min(tracking::kMaxCellRows, scene.side - row), 1, bias.data(), cells.data());
      benchmark::DoNotOptimize(cells.data());
    }
    return 1;
  });
  // Image, reference, weight; residual, its weight, the gradient of both, intensity and weighted terms, fourteen sums.
  roofline(state, 3 * 4, 3 + 5 + 10 + 5 + 24);
}

// At the finest level: warp, scale of the residual, sums, solution.
void iteration(State& state) {
  const Scene scene(state);
  tracking::EsmConfig config;
  config.levels = 1;
  config.min_step = 0.0001;
  tracking::Esm esm(config);
  esm.setReference(scene.reference, scene.roi);
  double iterations = 0.0;
  measure(state, scene.pixels(), [&] {
    const int done = esm.align(scene.current, tracking::EsmState()).iterations;
    iterations += done;
    return done;
  });
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  roofline(state, 12 + 12, 20 + 47);  // warp and sums
}

BENCHMARK(sums)->Name("kernel/sums")->Apply(sides);
BENCHMARK(iteration)->Name("kernel/esm_iteration")->Apply(sides);

}  // namespace

}  // namespace laparoscope_servo::bench
