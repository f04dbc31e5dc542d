#include "servo/prediction/frequency_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::servo {

namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kTrend = 3;
constexpr int kHarmonics = 3;
constexpr int kColumns = kTrend + 2 * kHarmonics;
constexpr double kAboutAsDeep = 1.5;
// Step of the grid of frequencies times the length T of the window. At half a step d beside its frequency, the fit of a
// sinusoid misses 1 - sinc^2(pi d T) of its power: 2 %, so that no minimum falls between two points of the grid.
constexpr double kStep = 0.15;

using Row = Eigen::Matrix<double, kColumns, 1>;
using Normal = Eigen::Matrix<double, kColumns, kColumns>;
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kColumns, kColumns>;
using RightSide = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kColumns, kMaxChannels>;

class Window {
 public:
  explicit Window(const std::vector<TimedChannels>& samples)
      : samples_(samples),
        middle_(0.5 * (samples.front().time + samples.back().time)),
        half_(0.5 * (samples.back().time - samples.front().time)) {}

  double length() const { return 2.0 * half_; }

  // Residual sum of squares of the fit; frequency 0: of the trend alone.
  double left(double frequency) const {
    const int used = frequency > 0.0 ? kColumns : kTrend;
    Normal a = Normal::Zero();
    RightSide b = RightSide::Zero(kColumns, samples_.front().z.size());
    double squares = 0.0;
    for (const TimedChannels& sample : samples_) {
      const Row row = rowAt(sample.time - middle_, frequency);
      const Channels z = sample.z - samples_.front().z;
      a.selfadjointView<Eigen::Lower>().rankUpdate(row);
      b.noalias() += row * z.transpose();
      squares += z.squaredNorm();
    }
    a.diagonal().array() += 1e-9 * static_cast<double>(samples_.size());
    const auto block = a.topLeftCorner(used, used);
    const RightSide right = b.topRows(used);
    const RightSide x = Eigen::LDLT<Block>(block.selfadjointView<Eigen::Lower>()).solve(right);
    const double left = squares - (x.array() * right.array()).sum();
    return std::isfinite(left) ? std::max(left, 0.0) : std::numeric_limits<double>::infinity();
  }

 private:
  Row rowAt(double time, double frequency) const {
    Row row = Row::Zero();
    const double t = time / half_;
    row[0] = 1.0;
    row[1] = t;
    row[2] = t * t;
    const double c = std::cos(kTwoPi * frequency * time);
    const double s = std::sin(kTwoPi * frequency * time);
    row[kTrend] = c;
    row[kTrend + 1] = s;
    for (int i = kTrend + 2; i < kColumns; i += 2) {
      row[i] = row[i - 2] * c - row[i - 1] * s;
      row[i + 1] = row[i - 2] * s + row[i - 1] * c;
    }
    return row;
  }

  const std::vector<TimedChannels>& samples_;
  double middle_;
  double half_;
};

struct Minimum {
  double frequency;
  double left;
};

// Golden section search within [low, high].
Minimum refined(const Window& window, double low, double high) {
  constexpr double kGolden = 0.6180339887498949;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double left_a = window.left(a);
  double left_b = window.left(b);
  for (int k = 0; k < 12; ++k) {
    if (left_a < left_b) {
      high = b;
      b = a;
      left_b = left_a;
      left_a = window.left(a = high - kGolden * (high - low));
    } else {
      low = a;
      a = b;
      left_a = left_b;
      left_b = window.left(b = low + kGolden * (high - low));
    }
  }
  return left_a < left_b ? Minimum{a, left_a} : Minimum{b, left_b};
}

std::vector<Minimum> deepestMinima(const Window& window, double low, double high) {
  const double step = kStep / window.length();
  const int count = std::max(2, static_cast<int>(std::ceil((high - low) / step)) + 1);
  std::vector<Minimum> grid;
  for (int k = 0; k < count; ++k) {
    const double frequency = low + (high - low) * k / (count - 1);
    grid.push_back({frequency, window.left(frequency)});
  }
  std::vector<std::size_t> minima;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const bool lower_before = k > 0 && grid[k - 1].left < grid[k].left;
    const bool lower_after = k + 1 < grid.size() && grid[k + 1].left < grid[k].left;
    if (!lower_before && !lower_after) minima.push_back(k);
  }
  std::sort(minima.begin(), minima.end(), [&](std::size_t i, std::size_t j) { return grid[i].left < grid[j].left; });
  if (minima.size() > 5) minima.resize(5);
  std::vector<Minimum> result;
  for (const std::size_t k : minima) {
    result.push_back(
        refined(window, grid[k > 0 ? k - 1 : 0].frequency, grid[std::min(k + 1, grid.size() - 1)].frequency));
  }
  return result;
}

}  // namespace

FoundFrequency findFrequency(const std::vector<TimedChannels>& samples, const FrequencyBand& band, double noise,
                             double min_periods) {
  FoundFrequency result;
  if (samples.size() < 2 * kColumns) return result;
  const Window window(samples);
  const double low = std::max(band.minimum, min_periods / window.length());
  if (!(window.length() > 0.0) || !(low <= band.maximum)) return result;
  const std::vector<Minimum> minima = deepestMinima(window, low, band.maximum);
  const auto least = std::min_element(minima.begin(), minima.end(),
                                      [](const Minimum& a, const Minimum& b) { return a.left < b.left; });
  const double values = static_cast<double>(samples.size()) * static_cast<double>(samples.front().z.size());
  const double enough = kAboutAsDeep * least->left + 0.5 * values * noise * noise;
  Minimum best = *least;
  for (const Minimum& one : minima) {
    if (one.left <= enough && one.frequency > best.frequency) best = one;
  }
  const double trend = window.left(0.0);
  if (!(trend > 0.0 && std::isfinite(trend))) return result;
  return {true, best.frequency, std::min(1.0, best.left / trend)};
}

}  // namespace laparoscope_servo::servo
