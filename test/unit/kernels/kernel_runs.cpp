// Compiled with KERNEL_RUN the name of the function, and, but for the shipped version, with the package's namespace
// renamed and its kernels beside it.
#include "kernel_runs.h"

#include <Eigen/Core>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/patch.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/image/warp.h"
#include "tracking/esm/esm_kernels.h"  // private to the part
#include "tracking/esm/esm_level.h"
#include "tracking/occlusion/colour_gate.h"
#include "tracking/occlusion/occlusion_gates.h"
#include "tracking/occlusion/structure_gate.h"

namespace kernel_test {

namespace image = laparoscope_servo::image;
namespace tracking = laparoscope_servo::tracking;

namespace {

template <typename T>
void append(const cv::Mat_<T>& from, std::vector<float>& to) {
  for (const T value : from) to.push_back(static_cast<float>(value));
}

Eigen::Matrix3d homography(const Inputs& inputs) {
  Eigen::Matrix3d g;
  for (int k = 0; k < 9; ++k) g(k / 3, k % 3) = inputs.g[static_cast<std::size_t>(k)];
  return g;
}

image::Patch patchOf(const cv::Mat1f& values) {
  image::Patch patch;
  patch.resize(values.cols, values.rows);
  values.copyTo(patch.view());
  return patch;
}

image::ColourPatch colourPatchOf(const cv::Mat& colours) {
  image::ColourPatch patch;
  image::warpNearest(colours, Eigen::Matrix3d::Identity(), colours.size(), patch);
  return patch;
}

void warp(const Inputs& inputs, Outputs& outputs) {
  image::Patch patch, valid;
  patch.resize(inputs.size.width, inputs.size.height);
  valid.resize(inputs.size.width, inputs.size.height);
  image::warpBilinear(inputs.grey, homography(inputs), patch, valid);
  append(patch.view(), outputs.warped);
  append(valid.view(), outputs.valid);
  image::ColourPatch colours;
  image::warpNearest(inputs.image, homography(inputs), inputs.size, colours);
  for (const cv::Mat1b& plane : {colours.blue, colours.green, colours.red, colours.valid})
    append(plane, outputs.colours);
}

void buildPyramid(const Inputs& inputs, Outputs& outputs) {
  image::RegionPyramid pyramid;
  pyramid.build(inputs.image, cv::Rect(cv::Point(0, 0), inputs.image.size()), 3, image::kLuma);
  for (int l = 0; l < pyramid.levels(); ++l) append(pyramid.level(l), outputs.pyramid);
}

void sum(const Inputs& inputs, Outputs& outputs) {
  image::Patch seen = patchOf(inputs.seen), reference = patchOf(inputs.reference);
  const image::Patch weight = patchOf(inputs.weight);
  seen.extrapolate();
  reference.extrapolate();
  tracking::CellInput input;
  input.image = &seen;
  input.reference = &reference;
  input.weight = &weight;
  input.gain = 1.1f;
  input.inverse_rejection = 1.0f / 40.0f;
  const std::vector<float> bias(static_cast<std::size_t>(seen.strips()), -3.0f);
  for (const int per_strip : {1, 2, 4}) {
    std::vector<tracking::CellSums> cells(static_cast<std::size_t>(seen.strips() * per_strip));
    for (int row = 0; row < seen.height(); row += tracking::kMaxCellRows) {
      tracking::sumCells(input, row, std::min(tracking::kMaxCellRows, seen.height() - row), per_strip, bias.data(),
                         cells.data());
      for (const tracking::CellSums& c : cells) {
        outputs.sums.insert(outputs.sums.end(),
                            {c.xx, c.xy, c.yy, c.xr, c.yr, c.x, c.y, c.xm, c.ym, c.w, c.r, c.m, c.mm, c.mr});
      }
    }
  }
}

void weigh(const Inputs& inputs, Outputs& outputs) {
  image::RegionPyramid pyramid;
  pyramid.build(inputs.image, cv::Rect(cv::Point(0, 0), inputs.image.size()), 2, image::kLuma);
  const laparoscope_servo::geometry::Rectangle roi = {10.0, 7.0, static_cast<double>(inputs.size.width),
                                                      static_cast<double>(inputs.size.height)};
  tracking::EsmLevel fine(pyramid, roi, 0), coarse(pyramid, roi, 1);
  cv::Mat1f(inputs.reference * 0.01f).copyTo(fine.weight.view());
  inputs.weight.copyTo(fine.valid.view());
  fine.useValid();
  append(fine.used.view(), outputs.level_weights);
  if (coarse.planes.empty()) return;
  std::vector<float> scratch;
  tracking::coarsenWeights(fine, scratch, coarse);
  append(coarse.weight.view(), outputs.level_weights);
}

void gate(const Inputs& inputs, Outputs& outputs) {
  const image::ColourPatch patch = colourPatchOf(inputs.colours);
  const image::AreaGrid grid(inputs.size.width, inputs.size.height, kAreas, kAreas);
  constexpr int kBins = 32;
  for (const tracking::ColourGate mode : {tracking::ColourGate::kPublished, tracking::ColourGate::kNormalised}) {
    tracking::ColourHistograms histograms(mode, kBins);
    histograms.compute(patch, grid);
    for (int area = 0; area < grid.count(); ++area) {
      outputs.histograms.insert(outputs.histograms.end(), histograms.histogram(area),
                                histograms.histogram(area) + kBins);
    }
  }
  constexpr int kBright = 200;
  cv::Mat1b saturated;
  image::saturatedPixels(patch, kBright, 1, saturated);
  append(saturated, outputs.saturated);
  tracking::OcclusionConfig config;
  config.rows = config.columns = kAreas;
  tracking::OcclusionGates gates(config, kBright);
  const int step = tracking::samplingStep(inputs.size, config);
  image::ColourPatch samples;
  image::warpNearest(inputs.colours, Eigen::Vector3d(step, step, 1.0).asDiagonal(),
                     cv::Size((inputs.size.width + step - 1) / step, (inputs.size.height + step - 1) / step), samples);
  gates.setReference(samples, inputs.size);
  gates.observeColour(samples);
  append(gates.weights().view(), outputs.weights);
}

void compareStructure(const Inputs& inputs, Outputs& outputs) {
  const image::Patch seen = patchOf(inputs.seen), reference = patchOf(inputs.reference),
                     weight = patchOf(inputs.weight);
  const image::AreaGrid grid(inputs.size.width, inputs.size.height, kAreas, kAreas);
  tracking::StructureStatistics statistics;
  const tracking::PatchPair pair = {&seen, &reference};
  statistics.compute(&pair, 1, weight, grid);
  for (int area = 0; area < statistics.count(); ++area) {
    const tracking::AreaMoments& m = statistics.area(area);
    outputs.moments.insert(outputs.moments.end(), {m.image, m.reference, m.both});
  }
}

}  // namespace

Outputs KERNEL_RUN(const Inputs& inputs) {
  Outputs outputs;
  warp(inputs, outputs);
  buildPyramid(inputs, outputs);
  sum(inputs, outputs);
  weigh(inputs, outputs);
  gate(inputs, outputs);
  compareStructure(inputs, outputs);
  return outputs;
}

}  // namespace kernel_test
