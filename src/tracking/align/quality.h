// Acceptance tests of an estimate. One is not enough: false fits can reach high correlations.
#pragma once

#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/esm/esm.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

// Share of the ROI that must be visible for an image to update the record.
constexpr double kRecordVisible = 0.4;

// Mean correlation, residual and innovation of the estimates of this ROI that were accepted. Limits are relative to
// them: tissue that deforms never correlates as well as a plane does, and a noisy camera leaves larger residuals.
class TrackRecord {
 public:
  // Adds an estimate that was accepted while tracking, `dt` [s] after the last one. `innovation` [px]: distance of its
  // worst corner from the prediction.
  void add(double zncc, double sigma, double innovation, double visible_fraction, double dt);

  double zncc() const { return zncc_; }
  double sigma() const { return sigma_; }            // grey levels
  double innovation() const { return innovation_; }  // px

 private:
  int count_ = 0;
  // Values before there is a record: typical of real tissue filmed by a real laparoscope.
  double zncc_ = 0.75;
  double sigma_ = 8.0;
  double innovation_ = 4.0;
};

// Result of block matching for an estimate.
struct BlockEvidence {
  int seen = 0;       // blocks in the image that have unique texture
  int confident = 0;  // blocks whose place is known, see BlockShift::confident
  // px of the image, median distance of the confident blocks from where the estimate puts them; NaN if there is none
  double off = 0.0;
  int visible = 0;                          // blocks seen that are not covered
  Matrix8d deformation = Matrix8d::Zero();  // see deformationCovariance
  double spread = 0.0;                      // 0 to 1, see spreadOfShifts
};

// lengthUnit()s of the image: if the median of the blocks is off by more, the estimate is wrong; an estimate counts as
// wrong from 5 px on.
constexpr double kMostOff = 4.0;

// With fewer blocks that have unique texture, block matching is inconclusive.
constexpr int kTellingBlocks = 8;

// Least number of confident blocks for an estimate to be accepted; 0 if there are too few blocks for a decision.
double leastBlocks(const BlockEvidence& blocks, double visible_fraction);

struct Evidence {
  EsmResult esm;
  geometry::Rectangle roi;                                  // px, in the reference
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Identity();  // G before ESM
  // true: the prediction comes from the last image; false: from a search, for which the tests are stricter
  bool from_track = false;
  // A search accepted this place in the image before, with at least min_return_fraction visible.
  bool confirming = false;
  double last_gain = 1.0;  // gain of the last accepted estimate
  // gain by the colours, an independent estimate of it; 0 if the colours show no change, see OcclusionGates::lightGain
  double light_gain = 0.0;
  double unseen = 0.0;            // s, since the last accepted estimate
  double visible_fraction = 0.0;  // 0 to 1
  double in_image = 1.0;          // 0 to 1, share of the ROI that lies in the image
  double zncc = 0.0;              // over the pixels used, with the areas' means subtracted
  BlockEvidence blocks;
  double corner_error = 0.0;    // px, claimed standard deviation of the worst corner: ESM's and the deformation's
  double centre_error = 0.0;    // px, the same for the centre
  double unproven = 0.0;        // s, since leastBlocks() blocks were last confident
  double proven_visible = 1.0;  // 0 to 1, visible_fraction then
  TrackRecord record;
};

// Enough blocks are where the estimate puts them: it is the ROI, whatever the illumination and the noise.
bool recognised(const Evidence& evidence);

// px: allowed distance of the worst corner from the prediction, for this visible share of the ROI and this corner error
// by the residuals. The less is visible, the smaller it is.
double allowedJump(const TrackRecord& record, const QualityConfig& config, const geometry::Rectangle& roi,
                   double visible_fraction, double corner_error);

// Rejection reason: the failed test with its value and limit; empty if all tests pass.
std::string doubt(const Evidence& evidence, const QualityConfig& config);

}  // namespace laparoscope_servo::tracking
