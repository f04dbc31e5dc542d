// The texture of the simulated tissue: generated from a seed, or from an image file.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace laparoscope_servo::sim {

// A square of reddish tissue with patches of fat and branching vessels, CV_8UC3 (blue, green, red), side x side px. It
// has structure at all scales, so that it can be tracked near and far. The same seed gives the same image. Throws
// std::invalid_argument unless 64 <= side <= 8192.
cv::Mat tissueTexture(int side, std::uint64_t seed);

// An image file of any kind that OpenCV reads, as CV_8UC3. Throws std::runtime_error with the file's name if it does
// not exist or is no image.
cv::Mat textureFromFile(const std::string& file);

}  // namespace laparoscope_servo::sim
