#include "features/shafts/grey_levels.h"

#include <algorithm>
#include <array>

namespace laparoscope_servo::features {

namespace {

// Redder than this is tissue, and how red it is does not matter.
constexpr double kRed = 0.75;
// Otsu's threshold lies in the middle between both kinds. Grey spreads less than tissue, so that the border between
// them is nearer to grey.
constexpr double kNearer = 0.85;
constexpr double kLeast = 0.06, kMost = 0.4;
constexpr double kShare =
    0.6;  // of the picture is at most as coloured as what is usual: instruments may take half of it

}  // namespace

GreyLevels greyLevels(const GreyMap& map, const image::FieldOfView& view) {
  constexpr int kTop = static_cast<int>(GreyMap::kZero + kRed * GreyMap::kUnit);
  std::array<double, kTop + 1> counts{};
  double all = 0.0, sum = 0.0;
  for (int y = 0; y < map.rows(); ++y) {
    const cv::Range& row = view.row(y);
    const uchar* colour = map.colour()[y];
    for (int x = row.start; x < row.end; ++x) {
      const int c = std::min(static_cast<int>(colour[x]), kTop);
      counts[static_cast<std::size_t>(c)] += 1.0;
      all += 1.0;
      sum += c;
    }
  }
  double below = 0.0, below_sum = 0.0, best = 0.0, otsu = GreyMap::kZero, usual = 0.0;
  bool reached = false;
  for (int c = 0; c < kTop; ++c) {
    below += counts[static_cast<std::size_t>(c)];
    below_sum += c * counts[static_cast<std::size_t>(c)];
    if (!reached && below >= kShare * all) {
      usual = c;
      reached = true;
    }
    if (!(below > 0.0 && below < all)) continue;
    const double apart = below_sum / below - (sum - below_sum) / (all - below);
    const double between = below * (all - below) * apart * apart;
    if (between > best) {
      best = between;
      otsu = c;
    }
  }
  if (!reached) usual = kTop;
  GreyLevels levels;
  levels.threshold =
      GreyMap::kZero + GreyMap::kUnit * std::clamp(kNearer * (otsu - GreyMap::kZero) / GreyMap::kUnit, kLeast, kMost);
  levels.usual = (usual - GreyMap::kZero) / GreyMap::kUnit;
  return levels;
}

}  // namespace laparoscope_servo::features
