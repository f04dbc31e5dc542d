#include "features/points/point_selection.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/image/image_type.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kSameSpot = 1.0;  // px

std::string refused(const Eigen::Vector2d& point, const std::string& expected) {
  std::ostringstream text;
  text << "point at (" << point.x() << ", " << point.y() << "), expected " << expected;
  return text.str();
}

// `index`: which point of all of them this is.
TrackedPoint firstView(const PointImage& picture, const Eigen::Vector2d& place, std::size_t index,
                       const PointsConfig& config, PointComparer& comparer) {
  TrackedPoint point(config.state);
  point.pose.place = place;
  if (!place.allFinite() || !picture.holds(place) || !point.view.take(picture, place, config.window / 2)) {
    throw RefusedFeature(index, refused(place, "a window of " + std::to_string(config.window) +
                                                   " px around it, in the picture and without highlights"));
  }
  comparer.compare(picture, point);
  if (!point.isSeen())
    throw RefusedFeature(index, refused(place, "texture around it that tells where it is in both directions"));
  return point;
}

// `before`: points of other pictures in front of these.
void find(PointPicture& picture, std::size_t source, std::size_t before, const PointImage& now, PointComparer& comparer,
          std::vector<TrackedPoint>& points) {
  for (TrackedPoint& point : points) point.reason = Reason::kNotSeen;
  const std::size_t enough = std::min(kFewestPoints, points.size());
  int matches = 0;
  for (const AgreedMotion& agreed : picture.find(now)) {
    if (lookBy(agreed.motion, source, now, comparer, points) >= enough) return;
    for (TrackedPoint& point : points) point.reason = Reason::kNotSeen;
    matches = std::max(matches, agreed.inliers);
  }
  std::ostringstream text;
  text << "picture with " << points.size() << " points, of which " << matches
       << " matches of its texture lead to fewer than " << enough << ", expected one that the image shows";
  throw RefusedFeature(before, text.str());
}

}  // namespace

std::size_t lookBy(const Eigen::Matrix3d& motion, std::size_t source, const PointImage& now, PointComparer& comparer,
                   std::vector<TrackedPoint>& points) {
  std::size_t seen = 0;
  for (TrackedPoint& point : points) {
    if (point.group != source) continue;
    if (!point.isSeen()) {
      placeBy(motion, point.view.place(), point.pose);
      comparer.look(now, point);
    }
    if (point.isSeen()) ++seen;
  }
  return seen;
}

PointChoice selectPoints(const PointImage& now, double stamp, const std::vector<PointGroup>& groups,
                         const PointsConfig& config, PointComparer& comparer) {
  PointChoice choice;
  for (const PointGroup& group : groups) {
    const bool is_live = group.picture.empty();
    PointImage other;
    if (!is_live) {
      image::checkType(group.picture);
      other.take(group.picture, config.levels, config.saturation);
    }
    const PointImage& picture = is_live ? now : other;
    const std::size_t source = choice.sources.size();
    std::vector<TrackedPoint> own;
    for (const Eigen::Vector2d& place : group.places) {
      const std::size_t index = choice.points.size() + own.size();
      for (const TrackedPoint& point : own) {
        if ((point.view.place() - place).norm() < kSameSpot)
          throw RefusedFeature(index, refused(place, "a place where no other point is"));
      }
      own.push_back(firstView(picture, place, index, config, comparer));
      own.back().group = source;
    }
    PointPicture reduced(picture);
    if (!is_live) find(reduced, source, choice.points.size(), now, comparer, own);
    for (TrackedPoint& point : own) {
      point.keeper.select(stamp);
      point.keeper.step(point.reason, stamp);
      choice.points.push_back(std::move(point));
    }
    choice.sources.emplace_back(std::move(reduced), config.window);
  }
  if (choice.points.empty()) throw std::invalid_argument("0 points, expected at least 1");
  return choice;
}

}  // namespace laparoscope_servo::features
