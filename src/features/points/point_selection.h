// Selects points: takes their first views, and finds those of another picture in the image.
#pragma once

#include <cstddef>
#include <limits>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "features/points/point_image.h"
#include "features/points/point_motion.h"
#include "features/points/point_picture.h"
#include "features/points/tracked_point.h"
#include "laparoscope_servo/features/points.h"

namespace laparoscope_servo::features {

constexpr std::size_t kFewestPoints = 3;  // that lead the others of their picture, and tell that it is seen

// What the points of one picture share.
struct PointSource {
  PointSource(PointPicture reduced, double window) : picture(std::move(reduced)), motion(window) {}

  PointPicture picture;
  PointMotion motion;                                           // from the picture to the present image
  bool leads = false;                                           // that motion is known
  double recall_at = -std::numeric_limits<double>::infinity();  // s
};

struct PointChoice {
  std::vector<TrackedPoint> points;
  std::vector<PointSource> sources;
};

// Puts the points of `source` where `motion` takes them, and looks for them there, but for those that are seen already.
// Returns how many are seen then.
std::size_t lookBy(const Eigen::Matrix3d& motion, std::size_t source, const PointImage& now, PointComparer& comparer,
                   std::vector<TrackedPoint>& points);

// See PointTracker::select.
PointChoice selectPoints(const PointImage& now, double stamp, const std::vector<PointGroup>& groups,
                         const PointsConfig& config, PointComparer& comparer);

}  // namespace laparoscope_servo::features
