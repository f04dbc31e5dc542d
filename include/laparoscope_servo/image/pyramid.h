// A pyramid around a region of an image, of one channel or several.
//
// Level l is 2^l times as coarse as the image. The centre of its pixel (0, 0) lies on the image's pixel origin(), so a
// point (u, v) of the image is ((u - origin.x) / 2^l, (v - origin.y) / 2^l) at level l.
//
// Level 0 is smoothed a little (sigma 0.65 px): bilinear interpolation is then accurate, and gradients are those of the
// tissue rather than of the noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

// Weights of blue, green and red in a tracked channel. BT.601 luma by default.
using ChannelWeights = std::array<float, 3>;
constexpr ChannelWeights kLuma = {0.114f, 0.587f, 0.299f};
constexpr int kMaxChannels = 3;

// One to kMaxChannels channels.
struct Channels {
  Channels(const ChannelWeights& one) : count(1), weights{one} {}  // NOLINT: a channel is channels
  Channels(const ChannelWeights& first, const ChannelWeights& second, const ChannelWeights& third)
      : count(3), weights{first, second, third} {}
  int count;
  std::array<ChannelWeights, kMaxChannels> weights;
};

// Level 0's smoothing: a kernel of three pixels with the variance of a Gaussian of sigma 0.65 px.
constexpr double kSmoothSide = 0.5 * 0.65 * 0.65;
constexpr double kSmoothMiddle = 1.0 - 2.0 * kSmoothSide;
// What it leaves of white noise with a standard deviation of 1: that of level 0, and the mean square of the central
// differences there, both directions together.
constexpr double kNoiseLeft = kSmoothMiddle * kSmoothMiddle + 2.0 * kSmoothSide * kSmoothSide;
constexpr double kNoiseGradient = (kSmoothMiddle * kSmoothMiddle + kSmoothSide * kSmoothSide) * kNoiseLeft;

class RegionPyramid {
 public:
  RegionPyramid() = default;
  RegionPyramid(RegionPyramid&&) noexcept = default;
  RegionPyramid& operator=(RegionPyramid&&) noexcept = default;

  // `image` is CV_8UC1 (there is then one channel, and weights are ignored) or CV_8UC3, blue first. `region` is cut to
  // the image; it must then hold at least one pixel, else std::invalid_argument. Buffers are reused.
  void build(const cv::Mat& image, const cv::Rect& region, int levels, const Channels& channels);

  int levels() const { return levels_; }
  int channels() const { return channels_; }
  const cv::Mat1f& level(int l, int channel = 0) const { return planes_[channel * levels_ + l].view; }
  cv::Point origin() const { return region_.tl(); }
  // Takes pixels of the image to those of level `l`.
  Eigen::Matrix3d levelFromImage(int l) const {
    const double size = 1 << l;
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    m.diagonal().head<2>().setConstant(1.0 / size);
    m.topRightCorner<2, 1>() << -origin().x / size, -origin().y / size;
    return m;
  }
  const cv::Rect& region() const { return region_; }

 private:
  // Memory is allocated once, for the whole image, since regions change in size from image to image; unused memory is
  // not touched.
  struct Plane {
    cv::Mat1f view;
    std::vector<float> data;
    void resize(const cv::Size& size, const cv::Size& most);
  };
  void smooth(const cv::Mat& image, const ChannelWeights& weights, cv::Mat1f& level);
  void halve(const cv::Mat1f& fine, cv::Mat1f& coarse);

  cv::Rect region_;
  int levels_ = 0;
  int channels_ = 0;
  std::vector<Plane> planes_;  // ordered by channel
  std::vector<float> rows_;
};

}  // namespace laparoscope_servo::image
