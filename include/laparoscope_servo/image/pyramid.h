// A pyramid around a region of an image, of one channel or several.
//
// Level l is scale(l) times as coarse as the image, twice as coarse as level l - 1; scale(0) is 1 unless another one is
// wanted. The centre of a level's pixel (0, 0) lies on the image's pixel origin(), so a point (u, v) of the image is
// ((u - origin.x) / scale, (v - origin.y) / scale) there.
//
// The image is smoothed a little (sigma 0.65 px) before anything else: bilinear interpolation is then accurate, and
// gradients are those of the tissue rather than of the noise.
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

// What a level shows of white noise in the image with a standard deviation of 1.
struct LevelNoise {
  double deviation = 0.0;  // standard deviation of a pixel
  double gradient = 0.0;   // mean square of the central differences, both directions together
};
// For a level of this scale, a power of 2.
LevelNoise levelNoise(int scale);

class RegionPyramid {
 public:
  RegionPyramid() = default;
  RegionPyramid(RegionPyramid&&) noexcept = default;
  RegionPyramid& operator=(RegionPyramid&&) noexcept = default;

  // `image` is CV_8UC1 (there is then one channel, and weights are ignored) or CV_8UC3, blue first. `region` is cut to
  // the image; it must then hold at least one pixel, else std::invalid_argument. `finest` is level 0's scale, a power
  // of 2. Buffers are reused.
  void build(const cv::Mat& image, const cv::Rect& region, int levels, const Channels& channels, int finest = 1);

  int levels() const { return levels_; }
  int channels() const { return channels_; }
  // px of the image per px of level `l`.
  int scale(int l) const { return 1 << (skipped_ + l); }
  const cv::Mat1f& level(int l, int channel = 0) const {
    return planes_[channel * (skipped_ + levels_) + skipped_ + l].view;
  }
  cv::Point origin() const { return region_.tl(); }
  // Takes pixels of the image to those of level `l`.
  Eigen::Matrix3d levelFromImage(int l) const {
    const double size = scale(l);
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
  int skipped_ = 0;  // levels finer than level 0
  int levels_ = 0;
  int channels_ = 0;
  std::vector<Plane> planes_;  // ordered by channel, then from fine to coarse, with the skipped levels
  std::vector<float> rows_;
};

}  // namespace laparoscope_servo::image
