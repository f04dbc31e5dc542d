// Every kernel that is compiled for several instruction sets, run on one input; kernel_runs.cpp is compiled once for
// each version of the kernels, see CMakeLists.txt.
#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace kernel_test {

struct Inputs {
  cv::Mat image;            // CV_8UC3
  cv::Mat1f grey;           // of the image's size
  std::array<double, 9> g;  // row by row: pixels of the patch to pixels of the image
  cv::Size size;            // of the patch
  // Of the patch's size.
  cv::Mat colours;  // CV_8UC3
  cv::Mat1f reference, seen, weight;
};

struct Outputs {
  std::vector<float> warped, valid;  // bilinear
  std::vector<float> gradient;       // x, then y
  std::vector<float> pyramid;        // of the image, all levels
  std::vector<float> colours;        // nearest neighbours, with their validity
  std::vector<float> saturated;      // mask of `colours`
  std::vector<float> sums;           // kSums for each cell
  std::vector<float> histograms;     // of `colours`, both features
  std::vector<float> moments;        // three for each area
  std::vector<float> weights;        // of the gates
};

constexpr std::size_t kSums = 14;
constexpr int kAreas = 4;  // in each direction

Outputs runShipped(const Inputs& inputs);   // as users get them: the best version that this processor has
Outputs runBaseline(const Inputs& inputs);  // for every processor of the family
Outputs runAvx2(const Inputs& inputs);      // only for a processor that has it

}  // namespace kernel_test
