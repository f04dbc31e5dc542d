// The versions of the kernels for several instruction sets agree within what image/multiversion.h states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "kernel_runs.h"
#include "laparoscope_servo/image/multiversion.h"

namespace kernel_test {
namespace {

constexpr double kSum = 1e-5;        // of the largest sum over the same pixels
constexpr double kPoint = 3e-7;      // of the image's width
constexpr double kDecisions = 1e-3;  // share of the pixels

// Not where the compiler cannot, or a sanitiser does not bear it.
#define KERNEL_TEST_TEXT(x) #x
#define KERNEL_TEST_EXPANDED_TEXT(x) KERNEL_TEST_TEXT(x)
[[maybe_unused]] const bool kMultiversioned = sizeof(KERNEL_TEST_EXPANDED_TEXT((LAPAROSCOPE_SERVO_CLONES))) >
                                              sizeof("()");

cv::Mat noise(const cv::Size& size, int type, double scale, cv::RNG& rng) {
  cv::Mat values(size, CV_MAKETYPE(CV_32F, CV_MAT_CN(type)));
  rng.fill(values, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(values, values, cv::Size(), scale);
  values = values * (40.0 * 3.545 * scale) + cv::Scalar::all(120.0);
  cv::Mat result;
  values.convertTo(result, type);
  return result;
}

Inputs randomInputs(const cv::Size& size, std::uint64_t seed) {
  cv::RNG rng(seed);
  Inputs inputs;
  const cv::Size around(2 * size.width + 61, 2 * size.height + 47);
  inputs.size = size;
  inputs.image = noise(around, CV_8UC3, 2.0, rng);
  inputs.grey = noise(around, CV_32FC1, 2.0, rng);
  // Turned, sheared and tilted; a part of the patch lies outside the image.
  const auto small = [&](double most) { return rng.uniform(-most, most); };
  inputs.g = {1.0 + small(0.2), small(0.3),       0.3 * size.width + small(0.5 * size.width),
              small(0.3),       1.0 + small(0.2), 0.3 * size.height + small(0.5 * size.height),
              small(3e-4),      small(3e-4),      1.0};
  inputs.colours = noise(size, CV_8UC3, 1.5, rng);
  inputs.reference = noise(size, CV_32FC1, 1.5, rng);
  inputs.seen = inputs.reference + (noise(size, CV_32FC1, 1.0, rng) - 120.0) * 0.1;
  cv::Mat1b visible = noise(size, CV_8UC1, 4.0, rng) > 90;
  visible.convertTo(inputs.weight, CV_32F, 1.0 / 255.0);
  return inputs;
}

double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(static_cast<double>(a[k]) - b[k]));
  return largest;
}

double shareThatDiffers(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t different = 0;
  for (std::size_t k = 0; k < a.size(); ++k) different += a[k] == b[k] ? 0 : 1;
  return static_cast<double>(different) / static_cast<double>(a.size());
}

double steepest(const cv::Mat1f& image) {
  double most = 0.0;
  for (int j = 0; j + 1 < image.rows; ++j) {
    for (int i = 0; i + 1 < image.cols; ++i) {
      const double right = std::abs(image(j, i + 1) - image(j, i));
      const double down = std::abs(image(j + 1, i) - image(j, i));
      most = std::max(most, right + down);
    }
  }
  return most;
}

void expectTheSameValuesWhereBothAreValid(const Inputs& inputs, const Outputs& a, const Outputs& b) {
  EXPECT_LE(shareThatDiffers(a.valid, b.valid), kDecisions);
  const double allowed = kPoint * inputs.grey.cols * steepest(inputs.grey);
  for (std::size_t k = 0; k < a.warped.size(); ++k) {
    if (a.valid[k] != b.valid[k]) continue;
    ASSERT_NEAR(a.warped[k], b.warped[k], allowed) << "pixel " << k;
  }
}

void expectTheSameSums(const Outputs& a, const Outputs& b) {
  for (std::size_t cell = 0; cell < a.sums.size(); cell += kSums) {
    double size = 0.0;
    for (std::size_t k = cell; k < cell + kSums; ++k) size = std::max(size, std::abs(static_cast<double>(a.sums[k])));
    for (std::size_t k = cell; k < cell + kSums; ++k) ASSERT_NEAR(a.sums[k], b.sums[k], kSum * size) << "sum " << k;
  }
}

// Of each histogram, half of the summed differences is the share of its pixels in another bin.
void expectTheSameHistograms(const Outputs& a, const Outputs& b) {
  double moved = 0.0, all = 0.0;
  for (std::size_t k = 0; k < a.histograms.size(); ++k) {
    moved += 0.5 * std::abs(a.histograms[k] - b.histograms[k]);
    all += a.histograms[k];
  }
  EXPECT_GT(all, 0.0);
  EXPECT_LE(moved, kDecisions * all);
}

void expectAgreement(const Inputs& inputs, const Outputs& a, const Outputs& b) {
  ASSERT_EQ(a.warped.size(), b.warped.size());
  ASSERT_EQ(a.colours.size(), b.colours.size());
  ASSERT_EQ(a.pyramid.size(), b.pyramid.size());
  ASSERT_EQ(a.sums.size(), b.sums.size());
  ASSERT_EQ(a.histograms.size(), b.histograms.size());
  ASSERT_EQ(a.moments.size(), b.moments.size());
  expectTheSameValuesWhereBothAreValid(inputs, a, b);
  expectTheSameSums(a, b);
  expectTheSameHistograms(a, b);
  EXPECT_LE(shareThatDiffers(a.colours, b.colours), kDecisions);
  EXPECT_LE(largestDifference(a.pyramid, b.pyramid), kSum * 255.0);
  EXPECT_LE(largestDifference(a.gradient, b.gradient), kSum * 255.0);
  // Differences of sums of squares: the tolerance is of these.
  EXPECT_LE(largestDifference(a.moments, b.moments), kSum * 255.0 * 255.0);
  // Nothing is rounded here.
  EXPECT_EQ(a.saturated, b.saturated);
  EXPECT_EQ(a.weights, b.weights);
}

class KernelVersions : public ::testing::TestWithParam<cv::Size> {};

TEST_P(KernelVersions, ShippedAgreesWithTheBaseline) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const Inputs inputs = randomInputs(GetParam(), seed);
    expectAgreement(inputs, runBaseline(inputs), runShipped(inputs));
  }
}

#ifdef KERNEL_TEST_AVX2
TEST_P(KernelVersions, Avx2AgreesWithTheBaseline) {
  if (__builtin_cpu_supports("avx2") == 0 || __builtin_cpu_supports("fma") == 0)
    GTEST_SKIP() << "this processor has no AVX2";
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const Inputs inputs = randomInputs(GetParam(), seed);
    expectAgreement(inputs, runBaseline(inputs), runAvx2(inputs));
  }
}
#endif

// Rounding differs between versions; were there none, the tests would compare a version with itself.
TEST(KernelVersionsTest, AreNotOneAndTheSame) {
#ifdef KERNEL_TEST_AVX2
  if (__builtin_cpu_supports("avx2") == 0 || __builtin_cpu_supports("fma") == 0)
    GTEST_SKIP() << "this processor has no AVX2";
  const Inputs inputs = randomInputs(cv::Size(196, 150), 1);
  const std::vector<float> baseline = runBaseline(inputs).sums;
  EXPECT_NE(baseline, runAvx2(inputs).sums);
  if (!kMultiversioned) return;
  EXPECT_NE(baseline, runShipped(inputs).sums);
#else
  GTEST_SKIP() << "one version only on this family of processors";
#endif
}

// Narrower than a strip; not a multiple of one; wider than the rows' chunks.
INSTANTIATE_TEST_SUITE_P(Sizes, KernelVersions,
                         ::testing::Values(cv::Size(11, 9), cv::Size(100, 75), cv::Size(301, 41)));

}  // namespace
}  // namespace kernel_test
