#include "model/visibility.h"

#include <algorithm>
#include <cmath>

#include "model/strands.h"

namespace laparoscope_servo::model {

namespace {

// Sines of the angle between a face's plane and the ray to its centre: 7, 6 and 5 degrees. A face that is flatter lies
// within a few pixels of its neighbour's edge.
constexpr double kAppears = 0.122, kBetween = 0.105, kDisappears = 0.087;
// px from the outline of what is in front: nearer than the edge stage's mask reaches, a piece shows that outline's
// edge.
constexpr double kHidesNear = 2.0, kHidesNearBefore = 3.5;

}  // namespace

Visibility::Visibility(const CadModel& model)
    : faces_(model.faces.size()),
      circles_(model.circles.size()),
      pieces_(static_cast<std::size_t>(Strands(model).count() * kPieces)) {}

bool Visibility::isTurnedToUs(double sine, bool was) const {
  return sine > (!known_ ? kBetween : was ? kDisappears : kAppears);
}

bool Visibility::pointsHere(const CadModel& model, int strand) const {
  const Strands strands(model);
  if (strands.isCircle(strand)) return circles_[static_cast<std::size_t>(strand - strands.edges - strands.sides)] != 0;
  if (!strands.isEdge(strand)) return true;
  const std::vector<int>& faces = model.edges[static_cast<std::size_t>(strand)].faces;
  return faces.empty() || std::any_of(faces.begin(), faces.end(), [this](int f) { return faceIsSeen(f); });
}

void Visibility::update(const CadModel& model, const Eigen::Isometry3d& camera_T_object, double focal,
                        Occluders& occluders, int step) {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Eigen::Vector3d centre = camera_T_object * model.faces[f].centre;
    const double sine = -(camera_T_object.linear() * model.faces[f].normal).dot(centre) / centre.norm();
    faces_[f] = isTurnedToUs(sine, faces_[f] != 0) ? 1 : 0;
  }
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    circles_[c] = isTurnedToUs(circleOpening(model.circles[c], camera_T_object), circles_[c] != 0) ? 1 : 0;
  }
  if (!model.convex) occluders.set(model, camera_T_object, faces_);
  const Strands strands(model);
  for (int strand = 0; strand < strands.count(); ++strand) {
    char* const pieces = pieces_.data() + strand * kPieces;
    const bool is_circle = strands.isCircle(strand);
    const Segment line = is_circle ? Segment() : segment(model, camera_T_object, strand);
    if (!pointsHere(model, strand) || (!is_circle && !line.exists)) {
      std::fill_n(pieces, kPieces, char(0));
      continue;
    }
    for (int first = 0; first < kPieces; first += step) {
      const double along = (first + 0.5 * step) / kPieces;
      bool seen = true;
      if (!model.convex) {
        const Eigen::Vector3d point =
            is_circle ? circlePoint(model.circles[static_cast<std::size_t>(strand - strands.edges - strands.sides)],
                                    camera_T_object, 2.0 * M_PI * along)
                            .point
                      : line.at(along);
        const bool hidden_before = known_ && pieces[first] == 0;
        seen = point.z() > 0.0 && !occluders.hides(point, (hidden_before ? kHidesNearBefore : kHidesNear) / focal);
      }
      std::fill_n(pieces + first, step, char(seen ? 1 : 0));
    }
  }
  known_ = true;
}

}  // namespace laparoscope_servo::model
