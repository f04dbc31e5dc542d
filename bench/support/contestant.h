// The trackers that are compared, behind one interface: this package's and its peers.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

struct Verdict {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // reference to current pixels, any scale
  bool claims = false;                              // the tracker says that it tracks
  bool idle = false;                                // it has stopped for good: it takes no time any more
  // What this package's tracker says beside that; of a peer it is everything that it claims, and nothing of errors.
  double visible_fraction = 1.0;
  double corner_error = std::numeric_limits<double>::quiet_NaN();  // px
  double centre_error = corner_error;                              // px
  int iterations = 0;
};

class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual std::string name() const = 0;
  // CV_8UC3; the ROI lies in the image. The image may be kept, nobody writes into it.
  virtual void select(const cv::Mat& image, const geometry::Rectangle& roi) = 0;
  virtual Verdict track(const cv::Mat& image) = 0;
};

constexpr double kPeriod = 0.04;  // s, between images, where nothing else is known

// This package's region tracker, as configured by default, for images that are `period` s apart.
std::unique_ptr<Contestant> makeOurs(double period = kPeriod);
// OpenCV's findTransformECC from where the last image left the ROI, on the grey image around it and `margin` px more.
constexpr double kEccMargin = 40.0;
std::unique_ptr<Contestant> makeEcc(double margin = kEccMargin);
// Corners of the reference, followed from image to image by pyramidal Lucas-Kanade around the ROI, `margin` px more,
// and a robust homography.
constexpr double kKltMargin = 48.0;
std::unique_ptr<Contestant> makeKlt(double margin = kKltMargin);
// A margin that takes in any image.
constexpr double kWholeImage = 1e5;
// ViSP's vpTemplateTrackerSSDESM with an SL(3) warp: as constructed, or with lambda 1e-6, gain 2 and `levels` of
// pyramid.
std::unique_ptr<Contestant> makeVispDefault();
std::unique_ptr<Contestant> makeVispTuned(unsigned int levels);

// All that this build has, ours first; with `names`, those only, which may also be ours by the channels that ESM
// tracks: ours_luma, ours_strongest, ours_colour. Throws std::invalid_argument for a name that there is not.
std::vector<std::unique_ptr<Contestant>> makeContestants(const std::vector<std::string>& names,
                                                         double period = kPeriod);

}  // namespace laparoscope_servo::bench
