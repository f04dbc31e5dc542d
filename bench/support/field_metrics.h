// The metrics that are published for trackers of points (TAP-Vid, STIR) and of planes (POT), of a region whose truth is
// known, so that others can compare.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/types.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// Areas of the region in each direction, as sequences with truth have them.
constexpr int kAreasAcross = 14;

// The points of a region that are judged: the centres of its areas, row by row.
std::vector<Eigen::Vector2d> regionPoints(const geometry::Rectangle& roi);

// px, between where two homographies take each point; infinite where the first takes it through infinity.
std::vector<double> distances(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth,
                              const std::vector<Eigen::Vector2d>& points);

// Which of the points can be seen: less than half of their area is covered, and they lie in the image. `covered`: the
// share of each area that is covered; empty where nothing is.
std::vector<char> visiblePoints(const Eigen::Matrix3d& truth, const std::vector<Eigen::Vector2d>& points,
                                const std::vector<double>& covered, const cv::Size& image);

// Counts points over the images of one sequence. The image with the reference is not counted.
class PointScores {
 public:
  static constexpr std::array<double, 5> kThresholds = {2.0, 4.0, 8.0, 16.0, 32.0};  // px

  // `claimed`: the tracker says that it tracks, which it says of all points at once.
  void add(const std::vector<double>& distance, const std::vector<char>& visible, bool claimed);

  // TAP-Vid's: the share of visible points that are claimed and nearer than the threshold, of the visible points and
  // those that are claimed though not visible or not so near; mean over the thresholds. NaN for no such points.
  double averageJaccard() const;
  // TAP-Vid's and STIR's: the share of visible points that are nearer than the threshold, whatever is claimed; mean
  // over the thresholds. NaN for no such points.
  double averageAccuracy() const;
  // The same, where a point that is not claimed counts as wrong.
  double averageClaimedAccuracy() const;

 private:
  using Counts = std::array<double, kThresholds.size()>;
  double shareOfVisible(const Counts& counts) const;

  double visible_ = 0.0;
  Counts near_{}, near_and_claimed_{}, wrongly_claimed_{};
};

// POT's: root mean square distance of the four corners, px; infinite where one goes through infinity.
double alignmentError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const geometry::Rectangle& roi);
// The share of errors under the limit; NaN for none.
double precision(const std::vector<double>& errors, double limit);

}  // namespace laparoscope_servo::bench
