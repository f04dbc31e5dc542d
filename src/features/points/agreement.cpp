#include "features/points/agreement.h"

#include <cstddef>

namespace laparoscope_servo::features {

namespace {

constexpr int kCells = 4;             // along each side
constexpr double kTexture = 0.1;      // of the window's variance, that a cell has to have
constexpr double kUnexplained = 0.5;  // of the cell's variance: a correlation of about 0.7

}  // namespace

double agreeingShare(const Window& view, const Window& now, const std::vector<float>& residuals) {
  const int side = view.side();
  int cells = 0, agreeing = 0;
  for (int c = 0; c < kCells * kCells; ++c) {
    const int left = (c % kCells) * side / kCells, right = (c % kCells + 1) * side / kCells,
              top = (c / kCells) * side / kCells, bottom = (c / kCells + 1) * side / kCells;
    double number = 0.0, sum = 0.0, squares = 0.0, unexplained = 0.0;
    for (int j = top; j < bottom; ++j) {
      for (int i = left; i < right; ++i) {
        const auto k = static_cast<std::size_t>(j * view.stride() + i);
        const double w = static_cast<double>(view.valid()[k]) * now.valid()[k], value = view.values()[k];
        number += w;
        sum += w * value;
        squares += w * value * value;
        unexplained += w * residuals[k] * residuals[k];
      }
    }
    if (2.0 * number < (right - left) * (bottom - top)) continue;
    const double texture = squares - sum * sum / number;
    if (!(texture > kTexture * number * view.contrast() * view.contrast())) continue;
    ++cells;
    if (unexplained <= kUnexplained * texture) ++agreeing;
  }
  return cells > 0 ? static_cast<double>(agreeing) / cells : 0.0;
}

}  // namespace laparoscope_servo::features
