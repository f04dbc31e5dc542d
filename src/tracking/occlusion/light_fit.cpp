#include "tracking/occlusion/light_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kClipped = 250;          // grey levels
constexpr float kMostClipped = 0.02f;  // share of an area's pixels; if more clip, the area's mean is biased
constexpr int kIterations = 6;         // of the weights, which hardly change any more after these
// grey levels, of an area's mean: the effect of texture that moved by a pixel
constexpr float kLeastSigma = 2.0f;
constexpr double kLeastWeight = 8.0;       // areas that a fitted line needs
constexpr double kLeastCorrelation = 0.7;  // of the areas' means; below it gain and offset cannot be separated
// Bounds of a plausible change of illumination: a lamp, and smoke that comes or clears.
constexpr float kMaxGain = 4.0f;
constexpr float kMaxVeil = 200.0f;  // grey levels that smoke adds to black

struct Line {
  ChannelLight light;
  double correlation = 0.0;
  bool known = false;
};

// Both means have errors, so the line's gain is the ratio of their spreads; an ordinary regression would underestimate
// it.
Line lineThrough(const AreaColours& image, const AreaColours& reference, int channel,
                 const std::vector<float>& weights) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (int area = 0; area < image.count(); ++area) {
    const double a = image.mean(channel, area), b = reference.mean(channel, area), w = weights[area];
    if (!(w > 0.0) || !std::isfinite(a + b)) continue;
    n += w;
    x += w * a;
    y += w * b;
    xx += w * a * a;
    yy += w * b * b;
    xy += w * a * b;
  }
  Line line;
  if (!(n >= kLeastWeight) || !(x > 0.0)) return line;
  x /= n;
  y /= n;
  xx = xx / n - x * x;
  yy = yy / n - y * y;
  xy = xy / n - x * y;
  line.known = true;
  line.correlation = xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
  const bool spread = line.correlation >= kLeastCorrelation;
  line.light.gain = static_cast<float>(spread ? std::sqrt(yy / xx) : y / x);
  line.light.offset = static_cast<float>(y - line.light.gain * x);
  return line;
}

bool possible(const ChannelLight& light) {
  return light.gain >= 1.0f / kMaxGain && light.gain <= kMaxGain && light.offset <= kMaxVeil &&
         -light.offset <= kMaxVeil * light.gain;
}

}  // namespace

float largestDifference(const ColourLight& a, const ColourLight& b) {
  float most = 0.0f;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const float black = a[c].offset - b[c].offset, white = black + 255.0f * (a[c].gain - b[c].gain);
    most = std::max({most, std::abs(black), std::abs(white)});
  }
  return most;
}

void AreaColours::compute(const image::ColourPatch& patch, const image::AreaGrid& grid) {
  const std::array<const cv::Mat1b*, 3> planes = {&patch.blue, &patch.green, &patch.red};
  for (std::vector<float>& means : means_) means.resize(grid.count());
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const int area = row * grid.columns() + column;
      std::array<int, 3> sum = {}, clipped = {};
      int pixels = 0;
      for (int j = grid.rowBegin(row); j < grid.rowBegin(row + 1); ++j) {
        const unsigned char* valid = patch.valid.ptr<unsigned char>(j);
        for (int i = grid.columnBegin(column); i < grid.columnBegin(column + 1); ++i) pixels += valid[i] & 1;
        for (std::size_t c = 0; c < planes.size(); ++c) {
          const unsigned char* values = planes[c]->ptr<unsigned char>(j);  // 0 where not valid
          for (int i = grid.columnBegin(column); i < grid.columnBegin(column + 1); ++i) {
            sum[c] += values[i];
            clipped[c] += static_cast<int>(values[i] >= kClipped);
          }
        }
      }
      const bool enough = 2 * pixels >= grid.pixelsIn(area);
      for (std::size_t c = 0; c < planes.size(); ++c) {
        const bool tells = enough && static_cast<float>(clipped[c]) <= kMostClipped * static_cast<float>(pixels);
        means_[c][area] =
            tells ? static_cast<float>(sum[c]) / static_cast<float>(pixels) : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
}

LightFit::LightFit(int areas) {
  for (std::vector<float>* buffer : {&weights_, &distances_, &values_}) buffer->reserve(areas);
}

// The median of the areas' ratios, which is right if half of the areas or more share the gain.
ChannelLight LightFit::commonGain(const AreaColours& image, const AreaColours& reference, int channel,
                                  const std::vector<char>& use) {
  values_.clear();
  for (int area = 0; area < image.count(); ++area) {
    const float ratio = reference.mean(channel, area) / image.mean(channel, area);
    if (use[area] && std::isfinite(ratio)) values_.push_back(ratio);
  }
  return {values_.empty() ? 1.0f : robust::median(values_), 0.0f};
}

// Tukey's weight of each area, by its squared residual, mean over the channels that are not NaN, each in units of its
// own scale.
void LightFit::weigh(const AreaColours& image, const AreaColours& reference, const std::vector<char>& use,
                     const ColourLight& light) {
  const int areas = image.count();
  weights_.assign(areas, 0.0f);    // number of channels until the end of this function
  distances_.assign(areas, 0.0f);  // sums of squared residuals
  for (int c = 0; c < 3; ++c) {
    const auto residual = [&](int area) {
      return light[c].gain * image.mean(c, area) + light[c].offset - reference.mean(c, area);
    };
    values_.clear();
    for (int area = 0; area < areas; ++area) {
      if (use[area] && std::isfinite(residual(area))) values_.push_back(std::abs(residual(area)));
    }
    if (values_.empty()) continue;
    const float sigma = std::max(kLeastSigma, static_cast<float>(robust::kMadToSigma) * robust::median(values_));
    for (int area = 0; area < areas; ++area) {
      const float r = residual(area) / sigma;
      if (!use[area] || !std::isfinite(r)) continue;
      distances_[area] += r * r;
      weights_[area] += 1.0f;
    }
  }
  constexpr float kTukey = static_cast<float>(robust::kTukey);
  for (int area = 0; area < areas; ++area) {
    if (!(weights_[area] > 0.0f)) continue;
    const float u = 1.0f - distances_[area] / weights_[area] / (kTukey * kTukey);
    weights_[area] = u > 0.0f ? u * u : 0.0f;
  }
}

std::optional<LightFit::Result> LightFit::fit(const AreaColours& image, const AreaColours& reference,
                                              const std::vector<char>& use, const ColourLight* start) {
  Result result = {};
  for (int c = 0; c < 3; ++c) result.light[c] = start != nullptr ? (*start)[c] : commonGain(image, reference, c, use);
  std::array<Line, 3> lines;
  for (int k = 0; k < kIterations; ++k) {
    weigh(image, reference, use, result.light);
    for (int c = 0; c < 3; ++c) {
      lines[c] = lineThrough(image, reference, c, weights_);
      if (lines[c].known) result.light[c] = lines[c].light;
    }
  }
  // A channel that clips everywhere gets the common gain of the others, that of the lamp.
  ChannelLight common = {0.0f, 0.0f};
  float known = 0.0f;
  for (const Line& line : lines) {
    if (!line.known) continue;
    common.gain += line.light.gain;
    common.offset += line.light.offset;
    result.correlation += line.correlation;
    known += 1.0f;
  }
  if (!(known > 0.0f)) return std::nullopt;
  result.correlation /= known;
  for (int c = 0; c < 3; ++c) {
    if (!lines[c].known) result.light[c] = {common.gain / known, common.offset / known};
    if (!possible(result.light[c])) return std::nullopt;
  }
  return result;
}

}  // namespace laparoscope_servo::tracking
