// Shafts in a single image: pairs of straight edges with grey between them, which enter through the border of the
// picture.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "features/shafts/grey_levels.h"
#include "features/shafts/grey_lines.h"
#include "features/shafts/grey_map.h"
#include "features/shafts/shaft.h"
#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::features {

class ShaftFinder {
 public:
  static constexpr int kMost = 3;

  // Best first; no two share an edge or most of their place.
  const std::vector<Shaft>& find(const GreyMap& map, const image::FieldOfView& view, const GreyLevels& levels);

 private:
  struct Scene {
    const GreyMap& map;
    const image::FieldOfView& view;
    double threshold;
    double contrast;
    double usual;
    bool isGrey(const Eigen::Vector2d& p) const;
    bool isInside(const Eigen::Vector2d& p) const;
  };

  bool pair(const Scene& scene, const GreyLine& a, const GreyLine& b, Shaft& shaft) const;
  bool single(const Scene& scene, const GreyLine& line, Shaft& shaft) const;
  bool enter(const Scene& scene, Shaft& shaft, double from, double& length) const;

  GreyLines finder_;
  std::vector<Shaft> candidates_, shafts_;
  std::vector<std::size_t> order_;  // of the candidates, best first
};

}  // namespace laparoscope_servo::features
