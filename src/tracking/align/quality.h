// Acceptance tests of an estimate. There are several, because false fits can reach high correlations.
#pragma once

#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/esm/esm.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

// Share of the ROI that has to be visible in an image for it to be learned from.
constexpr double kRecordVisible = 0.4;

// Mean correlation, residual and innovation of the estimates of this ROI that were accepted. Limits are relative to
// them: tissue that deforms never correlates as well as a plane does, and a noisy camera leaves larger residuals.
class TrackRecord {
 public:
  // An estimate that was believed while tracking, `dt` [s] after the one before. `innovation` [px]: how far its worst
  // corner was from the prediction.
  void add(double zncc, double sigma, double innovation, double visible_fraction, double dt);

  double zncc() const { return zncc_; }
  double sigma() const { return sigma_; }            // grey levels
  double innovation() const { return innovation_; }  // px

 private:
  int count_ = 0;
  // Until there is a record: what real tissue, filmed by a real laparoscope, shows.
  double zncc_ = 0.75;
  double sigma_ = 8.0;
  double innovation_ = 4.0;
};

// What block matching says of an estimate.
struct BlockEvidence {
  int seen = 0;       // blocks in the image that can be told from their surroundings
  int confident = 0;  // of which the place is known
  double off = 0.0;   // px of the image, their median distance from where the estimate has them; NaN without any
  int visible = 0;    // of those seen, that nothing covers
  Matrix8d deformation = Matrix8d::Zero();  // see deformationCovariance
};

// lengthUnit()s of the image: where the median of the blocks is off by more, the estimate is wrong, as it is from 5 px
// on.
constexpr double kMostOff = 4.0;

// How many blocks have to be found for an estimate; 0 where there are too few to tell.
double leastBlocks(const BlockEvidence& blocks, double visible_fraction);

struct Evidence {
  EsmResult esm;
  geometry::Rectangle roi;                                  // px, in the reference
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Identity();  // G before ESM
  bool from_track = false;  // the prediction comes from the image before; false: from a search, which has to prove more
  bool confirming = false;  // a search found it there in the image before, with as much visible as a return takes
  double last_gain = 1.0;   // of the last estimate that was believed
  double light_gain = 0.0;  // that the colours show, which says as much of the gain; 0 where they tell of none
  double unseen = 0.0;      // s, since the last estimate that was believed
  double visible_fraction = 0.0;  // 0 to 1
  double in_image = 1.0;          // 0 to 1, share of the ROI that lies in the image
  double zncc = 0.0;              // over the pixels used, the means of the areas taken out
  BlockEvidence blocks;
  double corner_error = 0.0;  // px, that is claimed: ESM's, and what the tissue deforms by
  double centre_error = 0.0;  // px
  double unproven = 0.0;      // s, since as many blocks as it takes were last found
  TrackRecord record;
};

// px: how far the worst corner may be from the prediction, when this share of the ROI is visible and the residuals
// predict this error of a corner. The less is seen, the more the past counts.
double allowedJump(const TrackRecord& record, const QualityConfig& config, const geometry::Rectangle& roi,
                   double visible_fraction, double corner_error);

// Why the estimate is not believed, the value and the limit; empty when every test is passed.
std::string doubt(const Evidence& evidence, const QualityConfig& config);

}  // namespace laparoscope_servo::tracking
