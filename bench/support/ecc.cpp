#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "bench/support/contestant.h"
#include "bench/support/crop.h"

namespace laparoscope_servo::bench {

namespace {

Eigen::Matrix3d translation(double x, double y) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 2) = x;
  m(1, 2) = y;
  return m;
}

class Ecc : public Contestant {
 public:
  explicit Ecc(double margin) : margin_(margin) {}
  std::string name() const override { return "ecc"; }

  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    roi_ = roi;
    const cv::Rect box(static_cast<int>(roi.x), static_cast<int>(roi.y), static_cast<int>(roi.width),
                       static_cast<int>(roi.height));
    smooth(image, reference_);
    reference_ = reference_(box).clone();
    g_.setIdentity();
  }

  Verdict track(const cv::Mat& image) override {
    const cv::Rect box = boxAround(g_, roi_, margin_, image.size());
    if (box.width < 16 || box.height < 16) return {g_, false, true};  // its last estimate left the image
    smooth(image(box), grey_);
    const Eigen::Matrix3d start = translation(-box.x, -box.y) * g_ * translation(roi_.x, roi_.y);
    cv::Mat1f warp(3, 3);
    for (int k = 0; k < 9; ++k) warp(k / 3, k % 3) = static_cast<float>(start(k / 3, k % 3) / start(2, 2));
    try {
      cv::findTransformECC(reference_, grey_, warp, cv::MOTION_HOMOGRAPHY,
                           cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-6), cv::noArray(),
                           1);
    } catch (const cv::Exception&) {  // its way to say that it did not converge
      return {g_, false};
    }
    Eigen::Matrix3d found;
    for (int k = 0; k < 9; ++k) found(k / 3, k % 3) = warp(k / 3, k % 3);
    if (!found.allFinite()) return {g_, false};
    g_ = translation(box.x, box.y) * found * translation(-roi_.x, -roi_.y);
    return {g_, true};
  }

 private:
  // What findTransformECC does by default (5 x 5), done here before the reference is cut out: at its border it would be
  // smoothed otherwise than the image is.
  static void smooth(const cv::Mat& image, cv::Mat& grey) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    cv::GaussianBlur(grey, grey, cv::Size(5, 5), 0.0);
  }

  double margin_;  // px
  geometry::Rectangle roi_;
  cv::Mat reference_, grey_;
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity();
};

}  // namespace

std::unique_ptr<Contestant> makeEcc(double margin) {
  return std::make_unique<Ecc>(margin);
}

}  // namespace laparoscope_servo::bench
