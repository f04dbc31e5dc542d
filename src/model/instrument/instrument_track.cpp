#include "model/instrument/instrument_track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "features/shafts/bright_edges.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::model {

namespace {

constexpr int kReturns = 2;                        // images in a row that show an instrument again
constexpr double kCoarse = 0.4;                    // cells, standard deviation of an outline of what is grey
constexpr double kApart = features::kStagesApart;  // cells by which both stages may differ
constexpr int kStray = 5;                          // images in a row in which they may differ by more
constexpr int kRetry = 4;                          // images between two attempts at the fine stage
// How far an instrument moves from one image to the next: entry, in widths of the shaft, more for each image in which
// it was missed, up to a limit; axis, as the cosine of the angle; width, as the ratio of the smaller to the larger one.
constexpr double kMoves = 1.0, kMovesMore = 0.25, kMovesMost = 3.0;
constexpr double kTurns = 0.9;
constexpr double kWidens = 0.6;
constexpr double kNearTrocar = 1.0;  // widths by which the axis of what returns may miss its trocar
constexpr double kFarthest = 4.0;    // diagonals of the picture: a motion that leads further out is none of a camera

Eigen::Vector2d toPixel(const GreyMap& map, const Eigen::Vector2d& p) {
  return {map.toPixel(p.x()), map.toPixel(p.y())};
}

Eigen::Vector2d toCell(const GreyMap& map, const Eigen::Vector2d& p) {
  return {map.toCell(p.x()), map.toCell(p.y())};
}

GreyLine fromEnds(const Eigen::Vector2d& begin, const Eigen::Vector2d& end, const GreyLine& like) {
  GreyLine line = like;
  const Eigen::Vector2d along = (end - begin).normalized();
  line.point = 0.5 * (begin + end);
  line.normal = {along.y(), -along.x()};
  line.end = 0.5 * (end - begin).norm();
  line.begin = -line.end;
  return line;
}

}  // namespace

InstrumentTrack::InstrumentTrack(const InstrumentConfig& config, int id, const InstrumentScene& scene,
                                 const Shaft& found)
    : config_(config),
      id_(id),
      keeper_({config.max_search_time, kReturns}),
      edges_{features::CurveTracker<features::Line>(config.edges),
             features::CurveTracker<features::Line>(config.edges)},
      failed_{kRetry, kRetry},
      shaft_(found) {
  keeper_.select(scene.stamp);
  update(scene, &found);
}

int InstrumentTrack::fineEdges() const {
  return (fine_[0] ? 1 : 0) + (fine_[1] ? 1 : 0);
}

void InstrumentTrack::predict(const InstrumentScene& scene) {
  if (!scene.motion) return;
  if (!scene.motion->isIdentity(1e-9)) meeting_.reset();
  const double farthest = kFarthest * std::hypot(scene.image.cols, scene.image.rows);
  std::array<GreyLine, 2> moved = shaft_.edges;
  for (GreyLine& edge : moved) {
    const Eigen::Vector2d begin = geometry::apply(*scene.motion, toPixel(scene.map, edge.at(edge.begin)));
    const Eigen::Vector2d end = geometry::apply(*scene.motion, toPixel(scene.map, edge.at(edge.end)));
    if (!(begin.norm() <= farthest && end.norm() <= farthest && (end - begin).norm() > scene.map.step())) return;
    edge = fromEnds(toCell(scene.map, begin), toCell(scene.map, end), edge);
  }
  follow(scene.view, moved, shaft_);
}

bool InstrumentTrack::isExpectedAt(const InstrumentScene& scene, const Shaft& found) const {
  if (isSame(shaft_, found)) return true;
  const double ratio = std::min(found.width, shaft_.width) / std::max(found.width, shaft_.width);
  const double moves = std::min(kMoves + kMovesMore * missed_, kMovesMost) * shaft_.width;
  if (ratio >= kWidens && shaft_.axis.dot(found.axis) >= kTurns && (found.entry - shaft_.entry).norm() <= moves)
    return true;
  if (keeper_.state() == features::State::kTracking) return false;
  // It may come back in another direction, but always through its trocar.
  const auto trocar = meeting_.point();
  if (!trocar) return false;
  const Eigen::Vector2d d = toCell(scene.map, *trocar) - found.entry;
  const double aside = std::abs(-found.axis.y() * d.x() + found.axis.x() * d.y());
  return aside < kNearTrocar * shaft_.width && std::abs(found.width - shaft_.width) < 0.5 * shaft_.width;
}

bool InstrumentTrack::agrees(const GreyMap& map, std::size_t k, const GreyLine& coarse) const {
  const features::Line& line = edges_[k].result().curve;
  for (const double t : {coarse.begin, coarse.end}) {
    const Eigen::Vector2d p = toPixel(map, coarse.at(t));
    if (!(std::abs(line.normal().dot(p) - line.rho()) <= kApart * map.step())) return false;
  }
  return line.normal().dot(coarse.normal) > 0.9;
}

void InstrumentTrack::trackEdges(const InstrumentScene& scene) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (!shaft_.seen[k] || edges_[k].result().state == features::State::kIdle) {
      fine_[k] = false;
      continue;
    }
    fine_[k] = edges_[k].track(scene.plane, scene.stamp, scene.motion).state == features::State::kTracking;
  }
}

void InstrumentTrack::checkEdges(const InstrumentScene& scene, const Shaft& found) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (!found.seen[k]) {
      fine_[k] = false;
      continue;
    }
    const GreyLine& coarse = found.edges[k];
    if (fine_[k]) {
      strayed_[k] = agrees(scene.map, k, coarse) ? 0 : strayed_[k] + 1;
      if (strayed_[k] < kStray) continue;
      edges_[k].reset();
      fine_[k] = false;
    }
    if (++failed_[k] < kRetry) continue;
    failed_[k] = 0;
    strayed_[k] = 0;
    const Eigen::Vector2d begin = toPixel(scene.map, coarse.at(coarse.begin)),
                          end = toPixel(scene.map, coarse.at(coarse.end));
    if (!((end - begin).norm() > features::Line::kMinLength)) continue;
    try {
      edges_[k].select(scene.plane, scene.stamp, features::Line(begin, end), kApart * scene.map.step() + 2.0);
      fine_[k] = agrees(scene.map, k, coarse);
      failed_[k] = fine_[k] ? kRetry : 0;
    } catch (const std::invalid_argument&) {
      // The image shows no such edge: what the outline of grey says has to do.
    }
  }
}

void InstrumentTrack::update(const InstrumentScene& scene, const Shaft* found) {
  trackEdges(scene);
  if (found != nullptr) checkEdges(scene, *found);
  Shaft now = found != nullptr ? *found : shaft_;
  std::array<GreyLine, 2> edges = now.edges;
  bool all_fine = true;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!now.seen[k]) continue;
    all_fine = all_fine && fine_[k];
    if (!fine_[k]) continue;
    const features::Line& line = edges_[k].result().curve;
    edges[k] = fromEnds(toCell(scene.map, line.begin()), toCell(scene.map, line.end()), edges[k]);
  }
  follow(scene.view, edges, now);
  const bool sound = now.length > 0.0 && now.width > 0.0 && std::isfinite(now.length) && std::isfinite(now.width);
  if (sound) silhouette_.grow(scene.map, scene.view, scene.levels.threshold, now);
  features::Reason reason = features::Reason::kNone;
  if (found == nullptr && !(all_fine && silhouette_.fill() >= config_.min_fill)) reason = features::Reason::kNotSeen;
  if (!sound || !silhouette_.found()) reason = features::Reason::kOutside;
  keeper_.step(reason, scene.stamp);
  missed_ = reason == features::Reason::kNone ? 0 : missed_ + 1;
  if (reason != features::Reason::kNone) return;
  shaft_ = now;
  kept_shaft_ = now;
  std::swap(kept_, silhouette_);
  meeting_.add(toPixel(scene.map, shaft_.entry), shaft_.axis);
}

double InstrumentTrack::edgeError(const GreyMap& map, std::size_t k) const {
  return fine_[k] ? edges_[k].result().expected_error : kCoarse * map.step();
}

void InstrumentTrack::tell(const GreyMap& map, const std::optional<geometry::PinholeCamera>& camera,
                           Instrument& result) const {
  result.id = id_;
  result.state = keeper_.state();
  result.reason = keeper_.reason();
  const bool tracking = result.state == features::State::kTracking;
  result.expected_error = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const GreyLine& line = shaft_.edges[k];
    InstrumentEdge& edge = result.edges[k];
    edge.seen = shaft_.seen[k];
    edge.fine = tracking && fine_[k];
    edge.begin = toPixel(map, line.at(line.begin));
    edge.end = toPixel(map, line.at(line.end));
    if (k == 0) std::swap(edge.begin, edge.end);  // towards the tip
    edge.theta = std::atan2(line.normal.y(), line.normal.x());
    edge.rho = line.normal.dot(toPixel(map, line.point));
    edge.expected_error = edgeError(map, k);
    edge.sites.clear();
    if (edge.fine) {
      features::tellSites(edges_[k].findings(), edge.sites);
      edge.covariance = edges_[k].result().curve.covariance(edges_[k].covariance());
    } else {
      // Of the middle across the line, and of its direction by both ends; rho is at the origin's foot.
      const double length = std::max(1.0, (edge.end - edge.begin).norm());
      const double lever = line.direction().dot(toPixel(map, line.point));
      const double offset = edge.expected_error * edge.expected_error, angle = 12.0 * offset / (length * length);
      edge.covariance << offset + lever * lever * angle, lever * angle, lever * angle, angle;
    }
    if (edge.seen) result.expected_error = robust::largest(result.expected_error, edge.expected_error);
  }
  if (!tracking) result.expected_error = std::numeric_limits<double>::infinity();
  result.entry = toPixel(map, shaft_.entry);
  result.axis = shaft_.axis;
  result.tip = toPixel(map, kept_.tip());
  result.tip_error = kCoarse * map.step();
  const auto homogeneous = [](const InstrumentEdge& e) {
    return Eigen::Vector3d(std::cos(e.theta), std::sin(e.theta), -e.rho);
  };
  result.vanishing_point = homogeneous(result.edges[0]).cross(homogeneous(result.edges[1])).normalized();
  result.trocar = meeting_.point();
  result.pose.reset();
  if (camera && config_.radius > 0.0 && shaft_.seen[0] && shaft_.seen[1]) {
    const auto outline = [](const InstrumentEdge& e) { return OutlineLine{e.rho, e.theta, e.covariance}; };
    result.pose = cylinderPose(*camera, config_.radius, {outline(result.edges[0]), outline(result.edges[1])},
                               result.tip, result.tip_error * result.tip_error);
  }
}

void InstrumentTrack::draw(const GreyMap& map, double threshold, cv::Mat1b& mask) {
  if (keeper_.state() == features::State::kLost) return;
  double error = kCoarse * map.step();
  for (std::size_t k = 0; k < 2; ++k) {
    if (shaft_.seen[k]) error = robust::largest(error, edgeError(map, k));
  }
  if (!std::isfinite(error)) error = kCoarse * map.step();
  kept_.draw(map, threshold, kept_shaft_, 2.0 * error, mask);
}

}  // namespace laparoscope_servo::model
