// The coarse stage: which motion of the whole curve puts most of its sites onto edges. It has no parameters of the
// curve, only displacements along normals, and bears that most sites see other edges, or none.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/features/edge_search.h"

namespace laparoscope_servo::features {

// A site's candidates, each with its weight: 0 takes no part.
struct WeightedCandidates {
  EdgeCandidates found;
  std::array<float, EdgeCandidates::kMost> weight{};
};

struct CoarseResult {
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();  // a similarity, px
  double score = 0.0;    // weights of the sites that agree, each the less the further it is from its edge
  double share = 0.0;    // of the score that all sites on edges would have
  double largest = 0.0;  // px along the normal, of any site
};

class CoarseMotion {
 public:
  void reserve(int sites);
  // `range`: how far a site may have moved. Sites without candidates are allowed. Deterministic.
  CoarseResult find(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates, double range);

 private:
  using Motion = Eigen::Vector4d;  // translation, px; growth and turn, px at the sites' mean distance from the centre

  void describe(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates);
  double score(const std::vector<WeightedCandidates>& candidates, const Motion& motion) const;
  Motion refined(const std::vector<WeightedCandidates>& candidates, const Motion& motion, double range) const;

  std::vector<Eigen::Vector4d> rows_;  // of each site's displacement along its normal, by the motion
  std::vector<int> with_candidates_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double radius_ = 1.0;
  double most_ = 0.0;  // score of sites that all lie on their best edge
};

}  // namespace laparoscope_servo::features
