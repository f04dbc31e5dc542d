#include "laparoscope_servo/tracking/structure_gate.h"

#include <cmath>
#include <limits>

namespace laparoscope_servo::tracking {

void structureDissimilarity(const cv::Mat1f& image, const cv::Mat1f& reference, const cv::Mat1f& valid, const LightModel& light,
                            double sigma, const image::AreaGrid& grid, std::vector<float>& dissimilarity) {
  dissimilarity.resize(grid.count());
  const float gain = static_cast<float>(light.gain);
  const float bias = static_cast<float>(light.bias);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      float n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      const int begin = grid.columnBegin(column);
      const int end = grid.columnBegin(column + 1);
      for (int j = grid.rowBegin(row); j < grid.rowBegin(row + 1); ++j) {
        const float* pi = image.ptr<float>(j);
        const float* pr = reference.ptr<float>(j);
        const float* pv = valid.ptr<float>(j);
#pragma omp simd reduction(+ : n, sa, sb, saa, sbb, sab)
        for (int i = begin; i < end; ++i) {
          const float w = pv[i];
          const float a = gain * pi[i] + bias;
          const float b = pr[i];
          n += w;
          sa += w * a;
          sb += w * b;
          saa += w * a * a;
          sbb += w * b * b;
          sab += w * a * b;
        }
      }
      const int area = row * grid.columns() + column;
      if (n < 0.5f * static_cast<float>(grid.pixelsIn(area))) {
        dissimilarity[area] = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      const double va = (saa - static_cast<double>(sa) * sa / n) / n;
      const double vb = (sbb - static_cast<double>(sb) * sb / n) / n;
      const double cov = (sab - static_cast<double>(sa) * sb / n) / n;
      dissimilarity[area] = static_cast<float>((va + vb - 2.0 * cov) / (0.5 * (va + vb) + sigma * sigma));
    }
  }
}

}  // namespace laparoscope_servo::tracking
