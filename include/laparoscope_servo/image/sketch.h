// A small picture of an image, and whether two images show the same place.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

struct Sketch {
  cv::Mat1f structure;             // grey levels; neither what is finer nor what is coarser than the blocks
  std::vector<cv::Point> corners;  // px of `structure`: upper left ones of the blocks that have structure
  bool dark = false;               // nothing can be seen in the image

  // Whether there is enough structure to be found again.
  bool tells() const;
};

// `image`: CV_8UC1 or CV_8UC3, of any size. What lies beyond the endoscope's field of view has no block.
Sketch sketchOf(const cv::Mat& image);

// Share of the blocks of `before`, 0 to 1, that `after` shows, moved as a neighbour is. Camera and tissue may have
// moved by a quarter of the image's larger side, and light may have changed. 1 where `before` does not tell; 0 for
// images of which one is wider than the other, seen from its height.
double likeness(const Sketch& before, const Sketch& after);

// How much of `between` is a sum of parts of the two others, pixel by pixel: 0 to 1, a multiple correlation
// coefficient. 0 where it is not of parts of both, and for images of different shapes.
double mixture(const Sketch& before, const Sketch& between, const Sketch& after);

}  // namespace laparoscope_servo::image
