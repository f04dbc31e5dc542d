// Drawn sequences in which contour, texture or both of a thing are covered in part, change or move fast; what is true
// is known.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "test/support/contour_scene.h"

namespace laparoscope_servo::bench {

struct ContourCase {
  std::string name;
  test_support::ContourScene::Look look;
  // Paints over the picture of the image k; null: nothing.
  std::function<void(const test_support::ContourScene&, int k, cv::Mat1f&)> cover;
};

// Textures, motion, what covers and where: by the seed.
std::vector<ContourCase> contourCases(unsigned seed);

}  // namespace laparoscope_servo::bench
