#include "tracking/align/region_aligner.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/align/channel_choice.h"
#include "tracking/align/detail.h"
#include "tracking/align/shift_fit.h"
#include "tracking/align/texture.h"
#include "tracking/esm/covariance.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kMaxStructureRounds = 3;
constexpr int kMostCorrections = 2;  // blocks that were too far to be found are found after the first
// ShiftFit::significance from which on the blocks are believed. Measured on four films of laparoscopy: 0.5
// and 1 give the same, 3 leaves half of what ESM is off by.
constexpr double kSignificant = 1.0;
// px of the level that blocks are searched on. Where their median is off by less, ESM is the more accurate.
constexpr double kNearOff = 0.3;
constexpr double kFarOff = 1.5;  // lengthUnit()s of the image, the blocks' median: ESM is off, however they scatter
constexpr double kMostMissing = 0.5;  // share of the blocks that are found, from which on they are not searched further
constexpr double kBlockVisible = 0.8;  // share of a visible block's pixels that have weight
constexpr double kGateShift = 2.0;  // lengthUnit()s of the image: masks drawn this far from the estimate are outdated
constexpr double kCoarse = 4.0;  // px of the image per px of the blocks' level; in a ROI of over 320 px one has 96 px
constexpr double kBorder = 4.0;  // px of the coarsest level, of what smoothing takes in from beyond the ROI

// The channel that is tracked first, before any smoothing. `image`: CV_8UC1 or CV_8UC3.
cv::Mat1f mixed(const cv::Mat& image, const image::ChannelWeights& weights) {
  cv::Mat levels, plane;
  image.convertTo(levels, CV_32F);
  if (image.channels() == 1) return levels;
  cv::transform(levels, plane, cv::Matx13f(weights[0], weights[1], weights[2]));
  return plane;
}

bool usable(const EsmResult& estimate) {
  return estimate.status == EsmStatus::kConverged || estimate.status == EsmStatus::kMaxIterations;
}

}  // namespace

int finestScale(const geometry::Rectangle& roi) {
  int scale = 1;
  while (roi.width * roi.height > kMostPixels * scale * scale) scale *= 2;
  return scale;
}

RegionAligner::RegionAligner(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config.esm),
      lens_(lens),
      occlusion_(config.occlusion),
      esm_(config.esm, lens),
      gates_(config.occlusion, config.esm.saturation),
      blocks_(lens),
      far_blocks_(lens) {}

void RegionAligner::setReference(const cv::Mat& image, const geometry::Rectangle& roi,
                                 const std::optional<image::Channels>& channels) {
  const cv::Rect box = image::seenBox(lens_.get(), roi.corners(), 0.0) & cv::Rect(cv::Point(0, 0), image.size());
  channels_ = channels ? *channels : chosenChannels(config_.channels, image(box), config_.saturation);
  finest_ = finestScale(roi);
  const cv::Rect with_border = image::seenBox(lens_.get(), roi.corners(), kBorder * (finest_ << config_.levels));
  noise_ = noiseOf(mixed(image(box), channels_.weights[0]), mask_.empty() ? mask_ : mask_(box));
  pyramid_.build(image, with_border, config_.levels, channels_, finest_);
  esm_.setReference(pyramid_, roi);
  blocks_.setReference(pyramid_, roi, mask_);
  far_blocks_.setReference(pyramid_, roi, blocks_.level() + 1, mask_);
  if (blocks_.scale() >= kCoarse) fine_blocks_.setReference(pyramid_, roi, std::max(blocks_.level() - 1, 0), mask_);
  deformation_ = DeformationMemory();
  sample(image, Eigen::Matrix3d::Identity());
  gates_.setReference(patch_, patchSize(), coloursIn(channels_));
  if (!mask_.empty() && cv::countNonZero(covered_.blue) > 0) gates_.hideInReference(covered_.blue);
  esm_.setWeights(weights());
}

ReferenceTexture RegionAligner::referenceTexture() {
  const cv::Mat1f plane = esm_.level(0).planes[0].value.view();
  const image::LevelNoise left = image::levelNoise(finest_);
  const double typical = kTypicalNoise * (left.deviation / image::levelNoise(1).deviation);
  ReferenceTexture result;
  result.noise = std::max(typical, left.deviation * noise_);
  esm_.setWeights(weights().mul(textureShare(plane, left.gradient * noise_ * noise_)));
  result.corner_error = esm_.referenceCornerError(result.noise);
  esm_.setWeights(weights());
  return result;
}

cv::Size RegionAligner::patchSize() const {
  return {esm_.level(0).width, esm_.level(0).height};
}

// Samples the image for the gates where `g` puts the ROI. What the mask covers is not valid, as outside of the image.
void RegionAligner::sample(const cv::Mat& image, const Eigen::Matrix3d& g) {
  sample(image, g, patch_);
  if (mask_.empty()) return;
  sample(mask_, g, covered_);
  patch_.valid.setTo(0, covered_.blue);
}

void RegionAligner::sample(const cv::Mat& image, const Eigen::Matrix3d& g, image::ColourPatch& patch) const {
  const cv::Size size = patchSize();
  const int step = samplingStep(size, occlusion_);
  Eigen::Matrix3d image_T_sample = g * esm_.level(0).image_T_patch;
  image_T_sample.leftCols<2>() *= step;
  const cv::Size samples((size.width + step - 1) / step, (size.height + step - 1) / step);
  image::warpNearest(image, image_T_sample, lens_.get(), samples, patch);
}

void RegionAligner::look(const cv::Mat& image, const Eigen::Matrix3d& g) {
  sample(image, g);
  gates_.observeColour(patch_);
  esm_.setWeights(weights());
  shown_ = g;
}

int RegionAligner::observeStructure(const EsmResult& estimate) {
  const EsmLevel& level = esm_.level(0);
  std::array<PatchPair, image::kMaxChannels> pairs;
  const int count = static_cast<int>(level.planes.size());
  for (int c = 0; c < count; ++c) pairs[c] = {&level.planes[c].warped, &level.planes[c].value};
  return gates_.observeStructure(pairs.data(), count, level.valid, estimate.state.gain, estimate.sigma);
}

Alignment RegionAligner::align(const cv::Mat& image, const EsmState& start, const MotionPrior* prior, double reach,
                               const AlignmentLimits& limits) {
  Alignment result;
  result.esm.state = start;
  result.esm.status = EsmStatus::kOutOfView;
  const double margin = reach + kBorder * esm_.level(esm_.levels() - 1).scale;
  const cv::Rect box = image::seenBox(lens_.get(), geometry::apply(start.g, roi().corners()), margin);
  result.in_image = !(box & cv::Rect(cv::Point(0, 0), image.size())).empty();
  if (!result.in_image) return result;
  pyramid_.build(image, box, config_.levels, channels_, finest_);
  // Where the prediction was off, so are masks that are drawn there; those of the image before move with the region.
  bool looked = prior == nullptr || surprise_ <= kGateShift * lengthUnit(roi());
  if (looked) look(image, start.g);
  esm_.allow(limits.most_work);
  result.esm.status = EsmStatus::kMaxIterations;
  if (limits.coarsest > 0) result.esm = esm_.align(pyramid_, start, prior, limits.coarsest, 1);
  int iterations = result.esm.iterations;
  double work = result.esm.work;
  const auto refine = [&] {
    result.esm = esm_.align(pyramid_, result.esm.state, prior, 0);
    iterations += result.esm.iterations;
    work += result.esm.work;
  };
  for (int k = 0; k < 2 && usable(result.esm); ++k) {
    const bool outdated =
        !looked || geometry::cornerDistance(shown_, result.esm.state.g, roi()) > kGateShift * lengthUnit(roi());
    if (k > 0 && !outdated) break;
    if (outdated) look(image, result.esm.state.g);
    looked = true;
    refine();
  }
  for (int round = 0; round < kMaxStructureRounds && usable(result.esm); ++round) {
    if (observeStructure(result.esm) == 0) break;
    esm_.setWeights(weights());
    refine();
  }
  result.esm.iterations = iterations;
  result.esm.work = work;
  if (usable(result.esm)) {
    const EsmLevel& level = esm_.level(0);
    result.visible_fraction = gates_.visibleFraction();
    if (!level.all_valid) result.share_in_image = cv::mean(level.valid.view())[0];
    result.zncc = gates_.correlation();
    surprise_ = geometry::cornerDistance(start.g, result.esm.state.g, roi());
    correct(result.esm, result.blocks);
    lookFurther(result.esm, result.blocks);
    correctFinely(result.esm, result.blocks);
    if (prior != nullptr) deformation_.complete(result.blocks.confident, result.blocks.deformation);
  }
  const Matrix8d covariance = result.esm.covariance + result.blocks.deformation;
  result.corner_error = std::isfinite(result.esm.corner_error) ? cornerError(result.esm.state.g, roi(), covariance)
                                                               : result.esm.corner_error;
  result.centre_error = std::isfinite(result.esm.centre_error) ? centreError(result.esm.state.g, roi(), covariance)
                                                               : result.esm.centre_error;
  return result;
}

void RegionAligner::follow(const ShiftFit& fit, EsmResult& estimate) const {
  estimate.state.g = geometry::normaliseDeterminant(esm_.steps().plus(estimate.state.g, fit.x));
  estimate.covariance = fit.covariance;
  estimate.corner_error = cornerError(estimate.state.g, roi(), fit.covariance);
  estimate.centre_error = centreError(estimate.state.g, roi(), fit.covariance);
}

const std::vector<BlockShift>& RegionAligner::measure(const EsmResult& estimate, BlockEvidence& evidence) {
  const std::vector<BlockShift>& shifts = blocks_.measure(pyramid_, estimate.state.g, mask_);
  evidence.seen = static_cast<int>(shifts.size());
  evidence.confident = confidentShifts(shifts);
  evidence.off = medianShift(shifts, estimate.state.g);
  evidence.spread = spreadOfShifts(shifts, roi(), blocks_.side());
  return shifts;
}

bool RegionAligner::isVisible(const Eigen::Vector2d& centre, double side) const {
  const EsmLevel& level = esm_.level(0);
  const cv::Mat1f weight = level.weight.view();
  const cv::Point middle(cvRound((centre.x() - level.image_T_patch(0, 2)) / level.scale),
                         cvRound((centre.y() - level.image_T_patch(1, 2)) / level.scale));
  const int half = static_cast<int>(side / level.scale / 2.0);
  const cv::Rect box = cv::Rect(middle.x - half, middle.y - half, 2 * half, 2 * half) & cv::Rect({0, 0}, weight.size());
  return cv::mean(weight(box))[0] >= kBlockVisible;
}

// Where blocks and ESM contradict each other the blocks are believed: moving light and shadows bias residuals, but not
// the places at which blocks are found.
void RegionAligner::correct(EsmResult& estimate, BlockEvidence& evidence) {
  const std::vector<BlockShift>* shifts = &measure(estimate, evidence);
  for (int round = 0; round < kMostCorrections; ++round) {
    const std::optional<ShiftFit> fit = fitShifts(*shifts, roi(), blocks_.side());
    if (!fit) break;
    const bool contradicts = evidence.off > kNearOff * blocks_.scale() &&
                             (fit->significance > kSignificant || evidence.off > kFarOff * lengthUnit(roi()));
    if (!contradicts && std::isfinite(estimate.corner_error)) break;
    follow(*fit, estimate);
    shifts = &measure(estimate, evidence);
  }
  evidence.visible = static_cast<int>(std::count_if(shifts->begin(), shifts->end(), [this](const BlockShift& block) {
    return isVisible(block.centre, blocks_.side());
  }));
  evidence.deformation = deformationCovariance(*shifts, evidence.off, roi());
}

// A part of the region that stands still (a reflection, a fold) holds ESM there, while the rest has moved further than
// blocks are searched. Where most blocks are missing they are searched further, and the place that more of them are at
// is the region's.
void RegionAligner::lookFurther(EsmResult& estimate, BlockEvidence& evidence) {
  if (evidence.seen == 0 || evidence.confident > kMostMissing * evidence.seen) return;
  const std::vector<BlockShift>& shifts = far_blocks_.measure(pyramid_, estimate.state.g, mask_);
  const BlockEvidence further = {static_cast<int>(shifts.size()), confidentShifts(shifts),
                                 medianShift(shifts, estimate.state.g)};
  const std::optional<ShiftFit> fit = fitShifts(shifts, roi(), far_blocks_.side());
  if (!fit || !(further.off > kFarOff * lengthUnit(roi())) || further.confident <= evidence.confident) return;
  EsmResult other = estimate;
  BlockEvidence there;
  follow(*fit, other);
  correct(other, there);
  if (there.confident > evidence.confident) {
    estimate = other;
    evidence = there;
  } else if (further.off > kMostOff * lengthUnit(roi())) {
    evidence = further;  // neither estimate is supported by its blocks
  }
}

// A block of a large region holds pieces that move differently, where tissue is curved or mirrors the light, and its
// place is that of the piece with most contrast. Blocks of half the side are believed where enough of them are found.
void RegionAligner::correctFinely(EsmResult& estimate, BlockEvidence& evidence) {
  if (!(blocks_.scale() >= kCoarse && evidence.confident > kMostMissing * evidence.seen)) return;
  // after the next call what that has measured
  const auto& shifts = fine_blocks_.measure(pyramid_, estimate.state.g, mask_);
  if (!(confidentShifts(shifts) > kMostMissing * fine_blocks_.blocks())) return;
  if (!(medianShift(shifts, estimate.state.g) > kNearOff * fine_blocks_.scale())) return;
  const std::optional<ShiftFit> fit = fitShifts(shifts, roi(), fine_blocks_.side());
  if (!fit || !(fit->significance > kSignificant)) return;
  follow(*fit, estimate);
  evidence.off = medianShift(fine_blocks_.measure(pyramid_, estimate.state.g, mask_), estimate.state.g);
  evidence.deformation = deformationCovariance(shifts, evidence.off, roi());
}

void RegionAligner::startAfresh() {
  surprise_ = 0.0;
  gates_.forget();
  esm_.forgetLight();
}

double RegionAligner::detail() const {
  const EsmLevel& level = esm_.level(0);
  const EsmPlane& plane = level.planes[0];
  return detailCorrelation(plane.warped.view(), plane.value.view(), level.weight.view().mul(level.valid.view()));
}

cv::Mat RegionAligner::occlusionMask(const Eigen::Matrix3d& g, const cv::Size& size) const {
  const image::AreaGrid& grid = gates_.grid();
  std::vector<uchar> covered(static_cast<std::size_t>(grid.count()));
  for (int area = 0; area < grid.count(); ++area) covered[area] = gates_.covered(area) ? 255 : 0;
  cv::Mat1b areas(grid.height(), grid.width());
  for (int j = 0; j < grid.height(); ++j) {
    for (int i = 0; i < grid.width(); ++i) areas(j, i) = covered[grid.areaOf(i, j)];
  }
  const geometry::Quadrilateral corners = geometry::apply(g, roi().corners());
  cv::Mat1b mask = cv::Mat1b::zeros(size);
  const cv::Rect box = image::seenBox(lens_.get(), corners, 1.0) & cv::Rect(cv::Point(0, 0), size);
  if (box.empty()) return mask;
  cv::Mat1b part = mask(box);
  image::drawMask(areas, g * esm_.level(0).image_T_patch, lens_.get(), box, part);
  return mask;
}

}  // namespace laparoscope_servo::tracking
