// Views of a region in real films, with what has been done to them known.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// A region, and images of the film that show it: where, the tracker has said.
struct Scene {
  std::string name;
  cv::Mat reference;
  geometry::Rectangle roi;
  std::vector<cv::Mat> before;  // the first images after the reference, a second of them at most
  std::vector<cv::Mat> images;
  std::vector<Eigen::Matrix3d> g;  // reference to the image's pixels
};

// FILM:x,y,w,h or FILM@N:x,y,w,h for a region of image N. Tracks the region to the film's end, or for `seconds`, and
// takes `count` of the images in which it was seen nearly whole. Throws std::runtime_error with the name.
Scene trackedScene(const std::string& text, int count, double seconds);

// What is done to an image.
struct Change {
  std::string name;
  double turn = 0.0;   // degrees
  double scale = 1.0;  // about the region
  double gain = 1.0;
  double veil = 0.0;  // share of grey that is mixed in
  bool half = false;  // of the region is covered
};

// The image so changed, about where `g` shows the region, with two grey levels of noise; `g` follows. What the film
// does not show is black. `random` says whereto it is moved besides; `grains` makes the noise, and may be the same.
cv::Mat changed(const cv::Mat& image, const Change& change, const geometry::Rectangle& roi, Eigen::Matrix3d& g,
                std::mt19937& random, std::mt19937& grains);

// s that this thread has computed: other programs do not count.
double threadSeconds();

}  // namespace laparoscope_servo::bench
