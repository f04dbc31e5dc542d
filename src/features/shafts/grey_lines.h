// Straight pieces of the outline of what is grey, found by a Hough transform in which each point of the outline votes
// for the lines that run across its own gradient.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "features/shafts/grey_map.h"
#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::features {

// Cells. The normal points from what is grey to what is not; the direction is the normal turned by 90 degrees:
// (-normal.y, normal.x).
struct GreyLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // on it
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double begin = 0.0, end = 0.0;  // along the direction, from `point`
  int support = 0;                // points of the outline
  double contrast = 0.0;          // of their colour, units of S0 cos H / mean

  Eigen::Vector2d direction() const { return {-normal.y(), normal.x()}; }
  Eigen::Vector2d at(double along) const { return point + along * direction(); }
  double length() const { return end - begin; }
  double distance(const Eigen::Vector2d& p) const { return normal.dot(p - point); }
};

class GreyLines {
 public:
  // `threshold`, as GreyMap::colour: below it is grey.
  const std::vector<GreyLine>& find(const GreyMap& map, const image::FieldOfView& view, double threshold);

 private:
  struct OutlinePoint {
    Eigen::Vector2f at;
    Eigen::Vector2f normal;
    float contrast;
    bool used;
  };

  // The highest vote of an angle; stale after its votes changed.
  struct Row {
    std::int16_t most = 0;
    int at = 0;
    bool stale = true;
  };

  void collect(const GreyMap& map, const image::FieldOfView& view, double threshold);
  void vote(const OutlinePoint& point, int sign);
  bool refine(GreyLine& line);
  bool isOn(const OutlinePoint& point, const GreyLine& line, double tolerance) const;

  std::vector<OutlinePoint> points_;
  std::vector<std::int16_t> votes_;
  std::vector<Row> rows_;
  std::vector<std::pair<double, std::size_t>> along_;
  int rho_bins_ = 0;
  int rho_zero_ = 0;
  std::vector<GreyLine> lines_;
};

}  // namespace laparoscope_servo::features
