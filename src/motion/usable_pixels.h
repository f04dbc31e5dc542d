// Which parts of an image can show motion: not highlights, not what is dark, not what a mask covers. In squares of a
// few pixels, and grown by one of them.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::motion {

// 1 where a square can be used, else 0.
using Squares = cv::Mat1b;

class UsablePixels {
 public:
  // Side of a square for images of this size, px: a power of 2, at least 4.
  static int sideFor(const cv::Size& size);

  // `image`: CV_8UC1 or CV_8UC3. `mask`: CV_8UC1 of its size, or empty: what is not 0 is left out. Does not allocate
  // for a further image of the same size and type.
  void look(const cv::Mat& image, const cv::Mat& mask, int saturation, int darkness);

  int side() const { return side_; }
  const Squares& squares() const { return squares_; }
  bool all() const { return all_; }

 private:
  void reduce(const cv::Mat& image, cv::Mat1b& brightest);
  void shrink();

  int side_ = 0;
  bool all_ = true;  // squares can be used
  Squares squares_, before_;
  cv::Mat1b brightest_, covered_;
  std::vector<unsigned char> row_;
};

struct JointUse {
  double usable = 0.0;  // share of the squares in the region, 0 to 1
  double within = 0.0;  // px^2, area of the region within the image
};

// What can be used of a pair of images: squares of the reference that are usable, lie in the region, and are usable in
// the current image where `g` takes their centres. `region`: in the reference image; null: all of it.
JointUse jointlyUsable(const UsablePixels& reference, const UsablePixels& current, const Eigen::Matrix3d& g,
                       const geometry::Quadrilateral* region, Squares& joint);

}  // namespace laparoscope_servo::motion
