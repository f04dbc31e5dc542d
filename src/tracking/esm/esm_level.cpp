#include "tracking/esm/esm_level.h"

#include <algorithm>

#include "laparoscope_servo/image/multiversion.h"
#include "laparoscope_servo/image/warp.h"
#include "tracking/esm/esm_kernels.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kMinSide = 8;  // px

// Blocks of light are about a twelfth of the ROI, to follow its shading, and at least a strip, to leave the texture's
// own contrast to the motion.
constexpr int kLightBlocksAlong = 12;

// Splits `size` into about equal parts, as many as fit with at least `least` each, and returns where they begin. All
// but the last are multiples of `unit`.
std::vector<int> split(int size, int unit, int least) {
  const int parts = std::clamp((size + least / 2) / least, 1, kLightBlocksAlong);
  std::vector<int> begins;
  for (int k = 0; k < parts; ++k) {
    const int begin = (k * size / parts + unit / 2) / unit * unit;
    if (begins.empty() || begin > begins.back()) begins.push_back(begin);
  }
  begins.push_back(size);
  return begins;
}

void copyTo(image::Patch& patch, const cv::Mat1f& pixels) {
  for (int j = 0; j < patch.height(); ++j) std::copy_n(pixels.ptr<float>(j), patch.width(), patch.row(j));
  patch.extrapolate();
}

LAPAROSCOPE_SERVO_CLONES
void leastOfThree(const float* __restrict a, const float* __restrict b, const float* __restrict c, int count,
                  float* __restrict least) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float ab = a[i] < b[i] ? a[i] : b[i];
    least[i] = ab < c[i] ? ab : c[i];
  }
}

LAPAROSCOPE_SERVO_CLONES
void keepInside(const float* __restrict weight, const float* __restrict above, const float* __restrict valid,
                const float* __restrict below, int count, float* __restrict used) {
#pragma omp simd
  for (int i = 0; i < count; ++i) used[i] = weight[i] * valid[i - 1] * valid[i] * valid[i + 1] * above[i] * below[i];
}

}  // namespace

EsmLevel::EsmLevel(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int l,
                   const image::Lens* lens) {
  const int size = reference.scale(l);
  // Without a lens the level's pixels are used as they are. With a lens they are resampled, starting at the ROI's first
  // pixel.
  const int x = lens != nullptr ? 0 : static_cast<int>(roi.x) - reference.origin().x;
  const int y = lens != nullptr ? 0 : static_cast<int>(roi.y) - reference.origin().y;
  const cv::Point begin((x + size - 1) / size, (y + size - 1) / size);
  const cv::Point end((x + static_cast<int>(roi.width) - 1) / size, (y + static_cast<int>(roi.height) - 1) / size);
  width = end.x - begin.x + 1;
  height = end.y - begin.y + 1;
  if (l > 0 && std::min(width, height) < kMinSide) return;

  scale = size;
  first = begin * size - cv::Point(x, y);
  image_T_patch << size, 0.0, roi.x + first.x,  //
      0.0, size, roi.y + first.y,               //
      0.0, 0.0, 1.0;
  weight.resize(width, height);
  weight.view().setTo(1.0f);
  used.resize(width, height);
  valid.resize(width, height);
  // Cells are an eighth of the patch or less, within which the Jacobian's polynomials hardly change.
  cells_per_strip = width >= 128 ? 1 : width >= 64 ? 2 : 4;
  cell_rows = height >= 256 ? 16 : height >= 128 ? 8 : height >= 64 ? 4 : 2;
  const std::vector<int> columns = split(width, image::Patch::kStrip, image::Patch::kStrip);
  light_row_begin = split(height, kMaxCellRows, image::Patch::kStrip);
  light_columns = static_cast<int>(columns.size()) - 1;
  light_column_of_strip.resize(weight.strips());
  for (int strip = 0; strip < weight.strips(); ++strip) {
    const auto next = std::upper_bound(columns.begin(), columns.end() - 1, strip * image::Patch::kStrip);
    light_column_of_strip[strip] = static_cast<int>(next - columns.begin()) - 1;
  }
  planes.resize(reference.channels());
  for (int c = 0; c < reference.channels(); ++c) {
    EsmPlane& plane = planes[c];
    plane.value.resize(width, height);
    if (lens != nullptr) {
      copyTo(plane.value, image::rectify(reference.level(l, c), image_T_patch, *lens, {reference.origin(), scale},
                                         cv::Size(width, height)));
    }
    plane.warped.resize(width, height);
    plane.bias.assign(light_columns * (light_row_begin.size() - 1), 0.0);
    plane.mean = plane.before = plane.bias;
  }
  if (lens == nullptr) take(reference, l);
}

void EsmLevel::take(const image::RegionPyramid& reference, int l) {
  const int size = reference.scale(l);
  const cv::Rect box((static_cast<int>(image_T_patch(0, 2)) - reference.origin().x) / size,
                     (static_cast<int>(image_T_patch(1, 2)) - reference.origin().y) / size, width, height);
  for (int c = 0; c < reference.channels(); ++c) copyTo(planes[c].value, reference.level(l, c)(box));
}

void EsmLevel::centreLight() {
  for (EsmPlane& plane : planes) {
    std::vector<double> pixels(plane.mean.size(), 0.0);
    for (int row = 0; row + 1 < static_cast<int>(light_row_begin.size()); ++row) {
      for (int j = light_row_begin[row]; j < light_row_begin[row + 1]; ++j) {
        for (int i = 0; i < width; ++i) {
          const int block = row * light_columns + light_column_of_strip[i / image::Patch::kStrip];
          plane.mean[block] += plane.value(j, i);
          pixels[block] += 1.0;
        }
      }
    }
    for (std::size_t block = 0; block < pixels.size(); ++block) plane.mean[block] /= pixels[block];
  }
}

void EsmLevel::useValid() {
  // Pixels beyond the patch count as valid.
  for (int j = 0; j < height; ++j) valid.row(j)[-1] = valid.row(j)[width] = 1.0f;
  std::fill_n(valid.row(-1), width, 1.0f);
  std::fill_n(valid.row(height), width, 1.0f);
  for (int j = 0; j < height; ++j) {
    keepInside(weight.row(j), valid.row(j - 1), valid.row(j), valid.row(j + 1), width, used.row(j));
  }
}

void matchLightBlocks(const EsmLevel& coarse, EsmLevel& fine) {
  fine.coarser_light_block.clear();
  // Takes a pixel coordinate of the fine level to the coarse one.
  const auto coarser = [&](double pixel, int fine_first, int coarse_first, int size) {
    return std::clamp(static_cast<int>((pixel * fine.scale + fine_first - coarse_first) / coarse.scale), 0, size - 1);
  };
  for (int row = 0; row + 1 < static_cast<int>(fine.light_row_begin.size()); ++row) {
    const double centre_row = 0.5 * (fine.light_row_begin[row] + fine.light_row_begin[row + 1] - 1);
    const int j = coarser(centre_row, fine.first.y, coarse.first.y, coarse.height);
    const auto next = std::upper_bound(coarse.light_row_begin.begin(), coarse.light_row_begin.end() - 1, j);
    const int coarse_row = static_cast<int>(next - coarse.light_row_begin.begin()) - 1;
    for (int column = 0; column < fine.light_columns; ++column) {
      const auto strips =
          std::equal_range(fine.light_column_of_strip.begin(), fine.light_column_of_strip.end(), column);
      const int begin = static_cast<int>(strips.first - fine.light_column_of_strip.begin()) * image::Patch::kStrip;
      const int end = static_cast<int>(strips.second - fine.light_column_of_strip.begin()) * image::Patch::kStrip;
      const int i = coarser(0.5 * (begin + std::min(end, fine.width) - 1), fine.first.x, coarse.first.x, coarse.width);
      fine.coarser_light_block.push_back(coarse_row * coarse.light_columns +
                                         coarse.light_column_of_strip[i / image::Patch::kStrip]);
    }
  }
}

void inheritLight(const EsmLevel& coarse, EsmLevel& fine) {
  for (std::size_t c = 0; c < fine.planes.size(); ++c) {
    const EsmPlane& from = coarse.planes[c];
    for (std::size_t block = 0; block < fine.planes[c].bias.size(); ++block) {
      const int k = fine.coarser_light_block[block];
      fine.planes[c].bias[block] += from.bias[k] - from.before[k];
    }
  }
}

void coarsenWeights(const EsmLevel& fine, std::vector<float>& scratch, EsmLevel& coarse) {
  const cv::Point offset = (coarse.first - fine.first) / static_cast<int>(fine.scale);
  scratch.resize(std::max(scratch.size(), static_cast<std::size_t>(fine.width) + 2));
  float* const least = scratch.data() + 1;
  for (int j = 0; j < coarse.height; ++j) {
    const int centre = std::min(2 * j + offset.y, fine.height - 1);
    leastOfThree(fine.weight.row(std::max(centre - 1, 0)), fine.weight.row(centre),
                 fine.weight.row(std::min(centre + 1, fine.height - 1)), fine.width, least);
    least[-1] = least[0];
    least[fine.width] = least[fine.width - 1];
    float* to = coarse.weight.row(j);
    for (int i = 0; i < coarse.width; ++i) {
      const int k = std::min(2 * i + offset.x, fine.width - 1);
      to[i] = std::min(std::min(least[k - 1], least[k]), least[k + 1]);
    }
  }
}

}  // namespace laparoscope_servo::tracking
