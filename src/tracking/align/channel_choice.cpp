#include "tracking/align/channel_choice.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kSets = 8;  // sets of channels, as bits: blue 1, green 2, red 4
// px, side of the square around a clipped pixel that smoothing and differentiation spoil
constexpr int kSpoiled = 5;
constexpr double kBrighter = 1.5;  // factor of brightness of a lamp that comes nearer
// share of the largest energy that counts as nearly as strong; the error of an estimate goes with its root
constexpr double kNearly = 0.95;

// For each set of channels: the energy, sum grad_c grad_d, of the pixels where exactly these channels clip.
using Energies = std::array<Eigen::Matrix3d, kSets>;

struct Gradients {
  cv::Mat3f x, y;
};

Gradients gradientsOf(const cv::Mat& patch) {
  cv::Mat3f smooth;
  Gradients g;
  patch.convertTo(smooth, CV_32FC3);
  cv::GaussianBlur(smooth, smooth, cv::Size(), 1.0);
  cv::Sobel(smooth, g.x, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(smooth, g.y, CV_32F, 0, 1, 1, 0.5);
  return g;
}

cv::Mat1b clippedSets(const cv::Mat& patch, double saturation) {
  cv::Mat1b sets = cv::Mat1b::zeros(patch.size());
  std::vector<cv::Mat> planes;
  cv::split(patch, planes);
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {kSpoiled, kSpoiled});
  for (int c = 0; c < 3; ++c) {
    cv::Mat clipped;
    cv::dilate(planes[c] >= saturation, clipped, square);
    sets |= clipped & (1 << c);
  }
  return sets;
}

Energies energiesOf(const Gradients& g, const cv::Mat1b& clipped) {
  Energies energies;
  energies.fill(Eigen::Matrix3d::Zero());
  for (int j = 0; j < clipped.rows; ++j) {
    for (int i = 0; i < clipped.cols; ++i) {
      const Eigen::Vector3d x(g.x(j, i)[0], g.x(j, i)[1], g.x(j, i)[2]);
      const Eigen::Vector3d y(g.y(j, i)[0], g.y(j, i)[1], g.y(j, i)[2]);
      energies[clipped(j, i)] += x * x.transpose() + y * y.transpose();
    }
  }
  return energies;
}

// Energy of a set's channels over the pixels where none of them clips.
Eigen::Matrix3d energyOf(const Energies& energies, int set) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int clipped = 0; clipped < kSets; ++clipped) {
    if ((clipped & set) == 0) sum += energies[clipped];
  }
  for (int c = 0; c < 3; ++c) {
    if ((set & (1 << c)) != 0) continue;
    sum.row(c).setZero();
    sum.col(c).setZero();
  }
  return sum;
}

struct Principal {
  double energy = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
};

Principal principalOf(const Eigen::Matrix3d& energy, int set) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(energy);
  if (solver.info() != Eigen::Success || !(solver.eigenvalues()[2] > 0.0)) return {};
  Principal principal = {solver.eigenvalues()[2], solver.eigenvectors().col(2)};
  for (int c = 0; c < 3; ++c) {
    if ((set & (1 << c)) == 0) principal.axis[c] = 0.0;  // exactly zero
  }
  return principal;
}

// Weights along the axis whose magnitudes sum to one, which keeps the range of grey levels.
image::ChannelWeights weightsAlong(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d w = axis * ((axis.sum() < 0.0 ? -1.0 : 1.0) / axis.cwiseAbs().sum());
  return {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])};
}

// Among the sets whose mixture has nearly the most energy in the present light, takes the one with the most energy in
// brighter light.
image::Channels strongestMixture(const cv::Mat& patch, int saturation) {
  const Gradients gradients = gradientsOf(patch);
  const Energies as_it_is = energiesOf(gradients, clippedSets(patch, saturation));
  const Energies brighter = saturation > 255  // nothing clips
                                ? as_it_is
                                : energiesOf(gradients, clippedSets(patch, saturation / kBrighter));
  std::array<Principal, kSets> now;
  double most = 0.0;
  for (int set = 1; set < kSets; ++set) {
    now[set] = principalOf(energyOf(as_it_is, set), set);
    most = std::max(most, now[set].energy);
  }
  int best = 0;
  double most_then = -1.0;
  for (int set = 1; set < kSets; ++set) {
    const double then = principalOf(energyOf(brighter, set), set).energy;
    if (now[set].energy < kNearly * most || then < most_then) continue;
    best = set;
    most_then = then;
  }
  if (!(now[best].axis.cwiseAbs().sum() > 0.0)) return image::kLuma;
  return weightsAlong(now[best].axis);
}

image::Channels bestColours(const cv::Mat& patch, int saturation) {
  const Energies energies = energiesOf(gradientsOf(patch), clippedSets(patch, saturation));
  int best = kSets - 1;
  for (int set = 1; set < kSets; ++set) {
    if (energyOf(energies, set).trace() > energyOf(energies, best).trace()) best = set;
  }
  image::Channels channels = image::kLuma;
  channels.count = 0;
  for (int c = 0; c < 3; ++c) {
    if ((best & (1 << c)) == 0) continue;
    channels.weights[channels.count] = {0.0f, 0.0f, 0.0f};
    channels.weights[channels.count++][c] = 1.0f;
  }
  return channels;
}

}  // namespace

image::Channels chosenChannels(TrackedChannels wanted, const cv::Mat& patch, int saturation) {
  if (patch.channels() == 1 || wanted == TrackedChannels::kLuma) return image::kLuma;
  return wanted == TrackedChannels::kStrongest ? strongestMixture(patch, saturation) : bestColours(patch, saturation);
}

std::optional<image::Channels> brightChannels(TrackedChannels wanted, const cv::Mat& patch, int saturation,
                                              const image::Channels& usual) {
  if (wanted != TrackedChannels::kStrongest || saturation > 255) return std::nullopt;  // 256: nothing clips
  const Energies brighter = energiesOf(gradientsOf(patch), clippedSets(patch, saturation / kBrighter));
  double most = 0.0;
  std::optional<image::Channels> best;
  for (int set = 1; set < kSets; ++set) {
    const Principal principal = principalOf(energyOf(brighter, set), set);
    if (!(principal.energy > most)) continue;
    most = principal.energy;
    best = weightsAlong(principal.axis);
  }
  return best && coloursIn(*best) != coloursIn(usual) ? best : std::nullopt;
}

std::array<bool, 3> coloursIn(const image::Channels& tracked) {
  std::array<bool, 3> used = {};
  for (int channel = 0; channel < tracked.count; ++channel) {
    for (int c = 0; c < 3; ++c) used[c] |= tracked.weights[channel][c] != 0.0f;
  }
  return used;
}

}  // namespace laparoscope_servo::tracking
