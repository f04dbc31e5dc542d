// What the machine can do at most: move bytes, and multiply and add.
#include <vector>

#include "bench/kernels/kernel_bench.h"
#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

LAPAROSCOPE_SERVO_CLONES
void addScaled(float* __restrict a, const float* __restrict b, const float* __restrict c, float s, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
}

LAPAROSCOPE_SERVO_CLONES
void copyFloats(float* __restrict a, const float* __restrict b, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i];
}

// range(0): kB that are touched in all.
void triad(State& state) {
  const std::size_t n = static_cast<std::size_t>(state.range(0)) * 1024 / (3 * sizeof(float));
  std::vector<float> a(n, 0.0f), b(n, 1.0f), c(n, 2.0f);
  for (auto _ : state) {
    addScaled(a.data(), b.data(), c.data(), 0.5f, n);
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * n * 3 * sizeof(float)));
}

void copy(State& state) {
  const std::size_t n = static_cast<std::size_t>(state.range(0)) * 1024 / (2 * sizeof(float));
  std::vector<float> a(n, 0.0f), b(n, 1.0f);
  for (auto _ : state) {
    copyFloats(a.data(), b.data(), n);
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * n * 2 * sizeof(float)));
}

// Within L1, L2 (twice), L3, and from memory, as most processors are.
void workingSets(benchmark::internal::Benchmark* limit) {
  for (const int kilobytes : {16, 200, 700, 6000, 131072}) limit->Arg(kilobytes);
}

// Chains of multiply-adds that do not depend on each other and stay in registers, kSteps long.
constexpr int kSteps = 1024;

// kLanes floats in a register, kChains registers.
template <int kLanes, int kChains>
struct Chains {
  static constexpr int kFloats = kLanes * kChains;
  typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

  // Inlined into what is compiled for each instruction set.
  __attribute__((always_inline)) static void run(float* values, float factor, float summand) {
    Lanes x[kChains];
    const Lanes zero = {};
    const Lanes f = zero + factor;
    const Lanes s = zero + summand;
    __builtin_memcpy(x, values, sizeof x);
    for (int step = 0; step < kSteps; ++step) {
#pragma GCC unroll 16
      for (int k = 0; k < kChains; ++k) x[k] = x[k] * f + s;
    }
    __builtin_memcpy(values, x, sizeof x);
  }
};

using Wide = Chains<16, 8>;
using Narrow = Chains<8, 10>;  // for sixteen registers: ten, and two operands

LAPAROSCOPE_SERVO_CLONES
void multiplyAddWide(float* values, float factor, float summand) {
  Wide::run(values, factor, summand);
}

LAPAROSCOPE_SERVO_CLONES
void multiplyAddNarrow(float* values, float factor, float summand) {
  Narrow::run(values, factor, summand);
}

// range(0): bits in a register.
void multiplyAdd(State& state) {
  alignas(64) float values[Wide::kFloats] = {};
  float factor = 0.999f, summand = 0.001f;
  benchmark::DoNotOptimize(factor);
  benchmark::DoNotOptimize(summand);
  const bool wide = state.range(0) == 512;
  for (auto _ : state) {
    wide ? multiplyAddWide(values, factor, summand) : multiplyAddNarrow(values, factor, summand);
    benchmark::DoNotOptimize(values);
  }
  const double flops = 2.0 * kSteps * (wide ? Wide::kFloats : Narrow::kFloats);
  state.counters["flops_per_second"] = Counter(flops, Counter::kIsIterationInvariantRate);
}

BENCHMARK(copy)->Name("machine/copy")->Apply(workingSets);
BENCHMARK(triad)->Name("machine/triad")->Apply(workingSets);
BENCHMARK(multiplyAdd)->Name("machine/multiply_add")->Arg(256)->Arg(512);

}  // namespace

}  // namespace laparoscope_servo::bench
