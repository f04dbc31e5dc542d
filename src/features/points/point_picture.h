// A picture whose points are to be found in another image, by described points and the motion on which they agree.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "features/points/point_image.h"
#include "laparoscope_servo/features/point_matching.h"

namespace laparoscope_servo::features {

class PointPicture {
 public:
  // Keeps a copy, reduced; its points are described when they are first needed.
  explicit PointPicture(const PointImage& picture);

  // Motions from the picture's pixels to those of `image`, that with the most matches first; none where too few agree.
  // Allocates, and takes as long as tens of images of tracking.
  std::vector<AgreedMotion> find(const PointImage& image);

 private:
  struct Reduced {
    cv::Mat1b grey, usable;
    double scale = 1.0;  // px of the image per px of the reduced one
  };
  static Reduced reduce(const PointImage& image);
  static DescribedPoints describe(const Reduced& reduced);

  Reduced reduced_;
  std::optional<DescribedPoints> described_;
};

}  // namespace laparoscope_servo::features
