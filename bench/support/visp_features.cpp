#include "bench/support/visp_features.h"

#include <visp3/blob/vpDot2.h>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImage.h>
#include <visp3/me/vpMe.h>
#include <visp3/me/vpMeEllipse.h>
#include <visp3/me/vpMeLine.h>

#include <cmath>

namespace laparoscope_servo::bench {

namespace {

void convert(const cv::Mat& image, vpImage<unsigned char>& grey) {
  grey.resize(static_cast<unsigned>(image.rows), static_cast<unsigned>(image.cols));
  image.copyTo(cv::Mat(image.rows, image.cols, CV_8UC1, grey.bitmap));
}

vpImagePoint point(const Eigen::Vector2d& p) {
  return vpImagePoint(p.y(), p.x());
}

// The thresholds are those of ViSP's tutorial on moving edges; range and distance of sites those of EdgeConfig.
vpMe movingEdges() {
  vpMe me;
  me.setRange(20);
  me.setSampleStep(4);
  me.setMaskSize(5);
  me.setMaskNumber(180);
  me.setThreshold(5000);
  me.setMu1(0.5);
  me.setMu2(0.5);
  return me;
}

// What it throws says that it lost the feature.
template <class Tracker>
bool tracks(Tracker& tracker, const vpImage<unsigned char>& image) {
  try {
    tracker.track(image);
    return true;
  } catch (const vpException&) {
    return false;
  }
}

}  // namespace

struct VispLine::Implementation {
  vpImage<unsigned char> image;
  vpMe me = movingEdges();
  vpMeLine line;
  bool lost = false;
};

VispLine::VispLine() : implementation_(std::make_unique<Implementation>()) {}
VispLine::~VispLine() = default;

void VispLine::select(const cv::Mat& image, const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  convert(image, implementation_->image);
  implementation_->line.setMe(&implementation_->me);
  implementation_->line.initTracking(implementation_->image, point(begin), point(end));
}

bool VispLine::track(const cv::Mat& image) {
  convert(image, implementation_->image);
  implementation_->lost = implementation_->lost || !tracks(implementation_->line, implementation_->image);
  return !implementation_->lost;
}

// A i + B j + C = 0, i being y and j x.
double VispLine::theta() const {
  return std::atan2(implementation_->line.getA(), implementation_->line.getB());
}

double VispLine::rho() const {
  return -implementation_->line.getC() / std::hypot(implementation_->line.getA(), implementation_->line.getB());
}

struct VispEllipse::Implementation {
  vpImage<unsigned char> image;
  vpMe me = movingEdges();
  vpMeEllipse ellipse;
  bool lost = false;
};

VispEllipse::VispEllipse() : implementation_(std::make_unique<Implementation>()) {}
VispEllipse::~VispEllipse() = default;

void VispEllipse::select(const cv::Mat& image, const std::vector<Eigen::Vector2d>& points) {
  convert(image, implementation_->image);
  implementation_->ellipse.setMe(&implementation_->me);
  std::vector<vpImagePoint> clicks;
  for (const Eigen::Vector2d& p : points) clicks.push_back(point(p));
  implementation_->ellipse.initTracking(implementation_->image, clicks);
}

bool VispEllipse::track(const cv::Mat& image) {
  convert(image, implementation_->image);
  implementation_->lost = implementation_->lost || !tracks(implementation_->ellipse, implementation_->image);
  return !implementation_->lost;
}

features::Ellipse VispEllipse::ellipse() const {
  const vpColVector abe = implementation_->ellipse.get_ABE();
  const vpImagePoint centre = implementation_->ellipse.getCenter();
  return features::Ellipse({centre.get_j(), centre.get_i()}, abe[0], abe[1], abe[2]);
}

struct VispDot::Implementation {
  vpImage<unsigned char> image;
  vpDot2 dot;
  bool lost = false;
};

VispDot::VispDot() : implementation_(std::make_unique<Implementation>()) {}
VispDot::~VispDot() = default;

// From between background and dot on: the default share of the dot's own level, 0.8, takes the background in.
void VispDot::select(const cv::Mat& image, const Eigen::Vector2d& point) {
  convert(image, implementation_->image);
  implementation_->dot.setGrayLevelPrecision(0.9);
  implementation_->dot.initTracking(implementation_->image, bench::point(point));
}

bool VispDot::track(const cv::Mat& image) {
  convert(image, implementation_->image);
  implementation_->lost = implementation_->lost || !tracks(implementation_->dot, implementation_->image);
  return !implementation_->lost;
}

Eigen::Vector2d VispDot::centre() const {
  const vpImagePoint cog = implementation_->dot.getCog();
  return {cog.get_j(), cog.get_i()};
}

}  // namespace laparoscope_servo::bench
