#include "tracking/align/region_aligners.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tracking/align/channel_choice.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kSamples = 4096.0;  // of the region, about: a share of it is known to 1 %
// The other mixture is taken where it keeps kFarMore times the share of the region that the usual one keeps; where the
// usual one is not right, or the other one was right lately, kMore times. It is left below kLeft times. In the
// reference's light both keep all of what they show of it.
constexpr double kFarMore = 2.0;
constexpr double kMore = 1.5;
constexpr double kLeft = 1.2;

}  // namespace

RegionAligners::RegionAligners(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config), lens_(lens), usual_(config, lens) {}

void RegionAligners::setBright(const cv::Mat& image) {
  bright_.reset();
  bright_now_ = false;
  if (image.channels() == 1) return;
  const geometry::Rectangle& roi = usual_.roi();
  samples_ = cv::Size(static_cast<int>(roi.width), static_cast<int>(roi.height));
  step_ = 1;
  sample(image, Eigen::Matrix3d::Identity());
  cv::Mat region;
  cv::merge(std::vector<cv::Mat>{patch_.blue, patch_.green, patch_.red}, region);
  const std::optional<image::Channels> channels =
      brightChannels(config_.esm.channels, region, config_.esm.saturation, usual_.channels());
  if (!channels) return;
  bright_.emplace(config_, lens_);
  bright_->setMask(usual_.mask());
  bright_->setReference(image, roi, *channels);
  step_ = std::max(1, static_cast<int>(std::sqrt(roi.width * roi.height / kSamples)));
  samples_ = cv::Size(std::max(1, region.cols / step_), std::max(1, region.rows / step_));
  usual_limits_ = limitsOf(usual_.channels());
  bright_limits_ = limitsOf(*channels);
  sample(image, Eigen::Matrix3d::Identity());
  reference_ = patch_.clone();
}

RegionAligners::Limits RegionAligners::limitsOf(const image::Channels& channels) const {
  const std::array<bool, 3> used = coloursIn(channels);
  Limits limits;
  for (int c = 0; c < 3; ++c) limits[c] = used[c] ? config_.esm.saturation : 256;
  return limits;
}

// Every step_-th pixel of the region, where `g` puts it.
void RegionAligners::sample(const cv::Mat& image, const Eigen::Matrix3d& g) {
  const geometry::Rectangle& roi = usual_.roi();
  Eigen::Matrix3d roi_T_sample = Eigen::Matrix3d::Identity();
  const double middle = 0.5 * (step_ - 1.0);
  roi_T_sample.topLeftCorner<2, 2>() *= step_;
  roi_T_sample.topRightCorner<2, 1>() << roi.x + middle, roi.y + middle;
  image::warpNearest(image, g * roi_T_sample, lens_.get(), samples_, patch_);
}

// Share of what the reference shows of a mixture that the current image shows as well.
double RegionAligners::left(const Limits& limits) const {
  int in_reference = 0, in_both = 0;
  for (int j = 0; j < samples_.height; ++j) {
    const unsigned char* const b = patch_.blue.ptr<unsigned char>(j);
    const unsigned char* const g = patch_.green.ptr<unsigned char>(j);
    const unsigned char* const r = patch_.red.ptr<unsigned char>(j);
    const unsigned char* const b0 = reference_.blue.ptr<unsigned char>(j);
    const unsigned char* const g0 = reference_.green.ptr<unsigned char>(j);
    const unsigned char* const r0 = reference_.red.ptr<unsigned char>(j);
    for (int i = 0; i < samples_.width; ++i) {
      const int before = static_cast<int>(b0[i] < limits[0]) & static_cast<int>(g0[i] < limits[1]) &
                         static_cast<int>(r0[i] < limits[2]);
      const int now =
          static_cast<int>(b[i] < limits[0]) & static_cast<int>(g[i] < limits[1]) & static_cast<int>(r[i] < limits[2]);
      in_reference += before;
      in_both += before & now;
    }
  }
  return in_both / std::max(1.0, static_cast<double>(in_reference));
}

// Whether the bright aligner has so many times more left than the usual one.
bool RegionAligners::brightHas(double more, const cv::Mat& image, const Eigen::Matrix3d& g) {
  sample(image, g);
  return patch_.has_colour && left(bright_limits_) > more * left(usual_limits_);
}

EsmState RegionAligners::choose(const cv::Mat& image, const EsmState& start) {
  if (!bright_) return start;
  const double more = bright_now_ ? kLeft : lights_[1].images <= config_.occlusion.hold ? kMore : kFarMore;
  const bool is_bright = brightHas(more, image, start.g);
  if (is_bright == bright_now_) return start;
  bright_now_ = is_bright;
  const Light& light = lights_[bright_now_];
  if (light.images <= config_.occlusion.hold) return {start.g, light.gain, light.bias};
  now().startAfresh();
  return start;
}

bool RegionAligners::turnBright(const cv::Mat& image, const Eigen::Matrix3d& g) {
  if (!bright_ || bright_now_ || !brightHas(kMore, image, g)) return false;
  bright_now_ = true;
  bright_->startAfresh();
  return true;
}

void RegionAligners::remember(const EsmState& accepted) {
  lights_[bright_now_] = {accepted.gain, accepted.bias, 0};
}

void RegionAligners::setMask(const cv::Mat& mask) {
  usual_.setMask(mask);
  if (bright_) bright_->setMask(mask);
}

void RegionAligners::startAfresh() {
  usual_.startAfresh();
  if (bright_) bright_->startAfresh();
}

void RegionAligners::advance() {
  for (Light& light : lights_) ++light.images;
  usual_.advance();
  if (bright_) bright_->advance();
}

void RegionAligners::retune(const TrackerConfig& config) {
  usual_.retune(config);
  if (bright_) bright_->retune(config);
}

}  // namespace laparoscope_servo::tracking
