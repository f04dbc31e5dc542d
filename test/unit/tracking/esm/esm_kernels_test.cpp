#include "tracking/esm/esm_kernels.h"  // private to the part

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::tracking {
namespace {

class SumCellsTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 41;
  static constexpr int kHeight = 21;
  image::Patch image_, reference_, weight_;
  CellInput input_;
  std::vector<float> bias_ = {3.0f, -2.0f, 0.5f};

  void SetUp() override {
    cv::RNG rng(12);
    for (image::Patch* patch : {&image_, &reference_, &weight_}) {
      patch->resize(kWidth, kHeight);
      cv::Mat1f view = patch->view();
      rng.fill(view, cv::RNG::UNIFORM, patch == &weight_ ? 0.0f : 50.0f, patch == &weight_ ? 1.0f : 80.0f);
    }
    image_.extrapolate();
    reference_.extrapolate();
    input_ = {&image_, &reference_, &weight_, 1.1f, 0.0f};
  }

  // In double precision, pixel by pixel.
  std::array<double, 14> expected(int cell, int per_strip, int first_row, int rows) const {
    std::array<double, 14> s = {};
    for (int j = first_row; j < first_row + rows; ++j) {
      const int columns = 16 / per_strip;
      for (int i = columns * cell; i < std::min(columns * (cell + 1), kWidth); ++i) {
        const double r = input_.gain * image_(j, i) + bias_[cell / per_strip] - reference_(j, i);
        const double tukey = std::max(0.0, 1.0 - std::pow(r * input_.inverse_rejection, 2));
        const double w = weight_(j, i) * tukey * tukey;
        const double x = 0.5 * input_.gain * (image_(j, i + 1) - image_(j, i - 1)) +
                         0.5 * (reference_(j, i + 1) - reference_(j, i - 1));
        const double y = 0.5 * input_.gain * (image_(j + 1, i) - image_(j - 1, i)) +
                         0.5 * (reference_(j + 1, i) - reference_(j - 1, i));
        const double m = 0.5 * (image_(j, i) + reference_(j, i));
        const double values[] = {x * x, x * y, y * y, x * r, y * r, x, y, x * m, y * m, 1.0, r, m, m * m, m * r};
        for (int k = 0; k < 14; ++k) s[k] += w * values[k];
      }
    }
    return s;
  }
  void check() {
    for (const int per_strip : {1, 2, 4}) {
      for (const auto& [first, rows] : {std::pair(0, 16), std::pair(16, 5), std::pair(3, 1)}) {
        std::vector<CellSums> sums(image_.strips() * per_strip);
        sumCells(input_, first, rows, per_strip, bias_.data(), sums.data());
        for (std::size_t cell = 0; cell < sums.size(); ++cell) {
          const std::array<double, 14> e = expected(static_cast<int>(cell), per_strip, first, rows);
          const float* found = &sums[cell].xx;
          double size = 0.0;
          for (double value : e) size = std::max(size, std::abs(value));
          for (int k = 0; k < 14; ++k) EXPECT_NEAR(found[k], e[k], 1e-5 * size) << "cell " << cell << ", sum " << k;
        }
      }
    }
  }
};

TEST_F(SumCellsTest, AreTheSumsOverThePixels) {
  check();
}

TEST_F(SumCellsTest, WeighByTukey) {
  input_.inverse_rejection = 1.0f / 20.0f;
  check();
}

TEST_F(SumCellsTest, ColumnsBeyondThePatchCountNothing) {
  weight_.view().setTo(1.0f);
  std::vector<CellSums> sums(image_.strips());
  sumCells(input_, 0, 8, 1, bias_.data(), sums.data());
  EXPECT_FLOAT_EQ(sums[0].w, 128.0f);
  EXPECT_FLOAT_EQ(sums[2].w, 8.0f * (kWidth - 32));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
