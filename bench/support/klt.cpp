#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "bench/support/contestant.h"
#include "bench/support/crop.h"
#include "bench/support/robust_fit.h"

namespace laparoscope_servo::bench {

namespace {

constexpr int kCorners = 200;
constexpr int kFewest = 8;

class Klt : public Contestant {
 public:
  explicit Klt(double margin) : margin_(margin) {}
  std::string name() const override { return std::string("klt_") + kRobustFitName; }

  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    roi_ = roi;
    g_.setIdentity();
    const cv::Rect box(static_cast<int>(roi.x), static_cast<int>(roi.y), static_cast<int>(roi.width),
                       static_cast<int>(roi.height));
    cv::Mat grey;
    cv::cvtColor(image(box), grey, cv::COLOR_BGR2GRAY);
    reference_.clear();
    cv::goodFeaturesToTrack(grey, reference_, kCorners, 0.01, 5.0);
    for (cv::Point2f& p : reference_) p += cv::Point2f(static_cast<float>(box.x), static_cast<float>(box.y));
    points_ = reference_;
    last_ = image;
  }

  Verdict track(const cv::Mat& image) override {
    const cv::Rect box = boxAround(g_, roi_, margin_, image.size());
    if (static_cast<int>(points_.size()) < kFewest || box.width < 32 || box.height < 32) {
      return {g_, false, true};
    }
    cv::cvtColor(last_(box), grey_before_, cv::COLOR_BGR2GRAY);
    cv::cvtColor(image(box), grey_, cv::COLOR_BGR2GRAY);
    last_ = image;
    const cv::Point2f origin(static_cast<float>(box.x), static_cast<float>(box.y));
    for (cv::Point2f& p : points_) p -= origin;
    cv::calcOpticalFlowPyrLK(grey_before_, grey_, points_, next_, status_, cv::noArray(), cv::Size(21, 21), 3);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < next_.size(); ++k) {
      if (status_[k] == 0) continue;
      reference_[kept] = reference_[k];
      next_[kept++] = next_[k] + origin;
    }
    reference_.resize(kept);
    next_.resize(kept);
    points_ = next_;
    if (static_cast<int>(kept) < kFewest) return {g_, false};
    const cv::Mat h = cv::findHomography(reference_, points_, kRobustFit, 3.0);
    if (h.empty()) return {g_, false};
    for (int k = 0; k < 9; ++k) g_(k / 3, k % 3) = h.at<double>(k / 3, k % 3);
    return {g_, true};
  }

 private:
  double margin_;  // px
  geometry::Rectangle roi_;
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity();
  cv::Mat last_, grey_before_, grey_;
  std::vector<cv::Point2f> reference_, points_, next_;
  std::vector<unsigned char> status_;
};

}  // namespace

std::unique_ptr<Contestant> makeKlt(double margin) {
  return std::make_unique<Klt>(margin);
}

}  // namespace laparoscope_servo::bench
