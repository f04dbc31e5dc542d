// The shaft of an instrument in the reduced picture: its edges, axis, entry and length.
#pragma once

#include <Eigen/Core>
#include <array>

#include "features/shafts/grey_lines.h"
#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::features {

// Cells. Edge 0 is on the right of who looks from the entry to the tip, y being downwards: its normal, which points
// away from the shaft, is nearly the axis (x, y) turned to (-y, x). Edge 1 is on the left; its direction is nearly the
// axis.
struct Shaft {
  std::array<GreyLine, 2> edges;
  // False: that side of the shaft lies beyond the picture; the edge is the picture's border.
  std::array<bool, 2> seen{true, true};
  Eigen::Vector2d entry = Eigen::Vector2d::Zero();  // of the axis into the picture
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  // direction, towards the tip
  double length = 0.0;                              // from entry to where the edges end
  double width = 0.0;                               // at the entry
  double fill = 0.0;                                // share of grey between the edges
  double score = 0.0;                               // points of the outline that speak for it
  double coverage = 0.0;                            // of its length by the shorter edge
  double clarity = 0.0;  // of the edge that differs less in colour, over the picture's usual colour
  double colour = 0.0;   // that nine tenths of what lies between the edges stay below, over that which counts as grey

  // Cells, between the edges, at `along` from the entry.
  double widthAt(double along) const;
  Eigen::Vector2d at(double along) const { return entry + along * axis; }
};

// `shaft` with other edges, which are near to its own: axis, entry, length and width follow from them.
void follow(const image::FieldOfView& view, const std::array<GreyLine, 2>& edges, Shaft& shaft);
// Whether one is where the other is: they point the same way, and cover each other for the most part.
bool isSame(const Shaft& a, const Shaft& b);
// Whether much of the shorter one's axis lies in the other one.
bool overlaps(const Shaft& a, const Shaft& b);

}  // namespace laparoscope_servo::features
