// The colours of a region of interest (ROI) in an image, without interpolation, for decisions per pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo::image {

// One plane per channel; an image without colour has only `blue`. `valid` is 255 where the pixel lies in the image,
// else 0, with black planes. Buffers are reused.
struct ColourPatch {
  cv::Mat1b blue, green, red, valid;
  bool has_colour = false;

  cv::Size size() const { return valid.size(); }
  ColourPatch clone() const { return {blue.clone(), green.clone(), red.clone(), valid.clone(), has_colour}; }
};

// patch(j, i) = the image's pixel nearest to the point that `g` takes (i, j, 1) to. `image` is CV_8UC1 or CV_8UC3, blue
// first; another type throws std::invalid_argument. Where the denominator of g is not positive, nothing is valid.
void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Size& size, ColourPatch& patch);

// warpNearest() through a lens: `g` takes (i, j, 1) to rectified pixels, `image` is the whole raw image. Pixels outside
// the lens's field are not valid. Null: there is no lens.
void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const Lens* lens, const cv::Size& size,
                 ColourPatch& patch);

// Mask: 255 where a channel (blue, green, red) is at least its threshold (grey levels; without colour, the least of
// them), dilated by `grow` px (0 to 64, else std::invalid_argument) in every direction; 0 elsewhere. Highlights move
// with the lamp rather than with the tissue, and their rims are bleached.
void saturatedPixels(const ColourPatch& patch, const std::array<int, 3>& thresholds, int grow, cv::Mat1b& mask);
inline void saturatedPixels(const ColourPatch& patch, int threshold, int grow, cv::Mat1b& mask) {
  saturatedPixels(patch, {threshold, threshold, threshold}, grow, mask);
}

}  // namespace laparoscope_servo::image
