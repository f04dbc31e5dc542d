// What the tests of trackers of features look at: a disc, a smaller one, and a half plane, with a selection for each
// kind of tracker.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/feature_selection.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::features::test {

using namespace laparoscope_servo::test;

constexpr double kPeriod = 0.04;                                      // s
inline const Eigen::Vector2d kDisc(90.0, 120.0), kSmall(90.0, 50.0);  // px
constexpr double kLine = 220.0;                                       // px, x of the line

// A disc, a smaller one, and the border of a half plane, `shift` px to the right.
inline cv::Mat scene(double shift, const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  const Eigen::Vector2d by(shift, 0.0);
  const Region disc = ellipse(kDisc + by, 25.0, 22.0, 0.3), small = ellipse(kSmall + by, 9.0, 9.0, 0.0),
               half = halfPlane(kLine + shift, 0.0);
  EdgeScene drawn;
  drawn.seed = static_cast<unsigned>(shift) + 1;
  return draw(
      drawn, [&](const Eigen::Vector2d& p) { return disc(p) || small(p) || half(p); }, cover);
}

inline cv::Mat covered() {
  return scene(1.0, [](cv::Mat1f& pixels) { pixels.setTo(100.0f); });
}

inline FeatureSelection dots() {
  FeatureSelection selection(2);
  selection[0].id = "large";
  selection[0].points = {kDisc};
  selection[1].id = "small";
  selection[1].points = {kSmall};
  selection[1].desired = Eigen::Vector2d(100.0, 60.0);
  return selection;
}

// Two places on the outline of the small disc, whose windows hold it in part.
inline FeatureSelection points() {
  FeatureSelection selection(2);
  selection[0].id = "middle";
  selection[0].points = {kSmall};
  selection[1].id = "beside";
  selection[1].points = {kSmall + Eigen::Vector2d(6.0, -4.0)};
  return selection;
}

// The outline of the large disc, `shift` px to the right.
inline Ellipse discOutline(double shift = 0.0) {
  return {kDisc + Eigen::Vector2d(shift, 0.0), 25.0, 22.0, 0.3};
}

// The same as points that a closed spline goes through.
inline SelectedFeature contour() {
  SelectedFeature selected;
  selected.id = "contour";
  selected.kind = FeatureKind::kSpline;
  selected.closed = true;
  for (int k = 0; k < 10; ++k) selected.points.push_back(discOutline().at(0.2 * M_PI * k));
  return selected;
}

inline FeatureSelection edges() {
  FeatureSelection selection(2);
  selection[0].id = "border";
  selection[0].kind = FeatureKind::kLine;
  selection[0].points = {{kLine + 1.0, 30.0}, {kLine - 1.0, 200.0}};
  selection[1].id = "rim";
  selection[1].kind = FeatureKind::kEllipse;
  selection[1].ellipse = EllipseSelection{kDisc, 26.0, 22.0, 0.3};
  return selection;
}

}  // namespace laparoscope_servo::features::test
