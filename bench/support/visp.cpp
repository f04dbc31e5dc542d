#include <visp3/core/vpException.h>
#include <visp3/core/vpImage.h>
#include <visp3/tt/vpTemplateTrackerSSDESM.h>
#include <visp3/tt/vpTemplateTrackerWarpHomographySL3.h>

#include <opencv2/imgproc.hpp>

#include "bench/support/contestant.h"

namespace laparoscope_servo::bench {

namespace {

class Visp : public Contestant {
 public:
  // 0 levels: as constructed.
  Visp(std::string name, unsigned int levels) : name_(std::move(name)), levels_(levels) {}
  std::string name() const override { return name_; }

  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    tracker_.reset();
    tracker_ = std::make_unique<vpTemplateTrackerSSDESM>(&warp_);
    if (levels_ > 0) {
      tracker_->setLambda(1e-6);
      tracker_->setGain(2.0);
      if (levels_ > 1) tracker_->setPyramidal(levels_, 0);
    }
    convert(image);
    const auto point = [](const Eigen::Vector2d& p) { return vpImagePoint(p.y(), p.x()); };
    const geometry::Quadrilateral c = roi.corners();
    tracker_->initFromPoints(grey_, {point(c[0]), point(c[1]), point(c[2]), point(c[0]), point(c[2]), point(c[3])});
    g_.setIdentity();
    lost_ = false;
  }

  Verdict track(const cv::Mat& image) override {
    if (lost_) return {g_, false, true};
    convert(image);
    try {
      tracker_->track(grey_);
    } catch (const vpException&) {  // its way to say that it lost the region; it does not come back
      lost_ = true;
      return {g_, false};
    }
    warp_.computeCoeff(tracker_->getp());
    const vpHomography h = warp_.getHomography();
    for (int k = 0; k < 9; ++k) g_(k / 3, k % 3) = h[static_cast<unsigned>(k / 3)][static_cast<unsigned>(k % 3)];
    return {g_, true};
  }

 private:
  void convert(const cv::Mat& image) {
    grey_.resize(static_cast<unsigned>(image.rows), static_cast<unsigned>(image.cols));
    cv::Mat view(image.rows, image.cols, CV_8UC1, grey_.bitmap);
    cv::cvtColor(image, view, cv::COLOR_BGR2GRAY);
  }

  std::string name_;
  unsigned int levels_;
  vpTemplateTrackerWarpHomographySL3 warp_;
  std::unique_ptr<vpTemplateTrackerSSDESM> tracker_;
  vpImage<unsigned char> grey_;
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity();
  bool lost_ = false;
};

}  // namespace

std::unique_ptr<Contestant> makeVispDefault() {
  return std::make_unique<Visp>("visp_default", 0);
}
std::unique_ptr<Contestant> makeVispTuned(unsigned int levels) {
  return std::make_unique<Visp>(levels > 1 ? "visp_tuned" : "visp_tuned_1", levels);
}

}  // namespace laparoscope_servo::bench
