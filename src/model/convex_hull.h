// The convex hull of points of the image, which is drawn around a model. OpenCV's allocates, which is not wanted while
// tracking.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace laparoscope_servo::model {

// Overwrites `hull`, px, with the corners of the hull in order, the first one again at the end; with all distinct
// points where there are fewer than three. Reorders `points`. Does not allocate where `hull` has room for one point
// more than there are.
void convexHull(std::vector<Eigen::Vector2d>& points, std::vector<Eigen::Vector2d>& hull);

}  // namespace laparoscope_servo::model
