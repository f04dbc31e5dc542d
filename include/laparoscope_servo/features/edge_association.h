// Which edge belongs to which site: one of the candidates each, as an equation of the fit; and, once the fit is solved,
// which of them agree with the curve.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "laparoscope_servo/features/coarse_motion.h"
#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/edge_search.h"
#include "laparoscope_servo/robust/irls.h"

namespace laparoscope_servo::features {

constexpr double kAgreeDistance = 1.0;  // px: an edge nearer than this agrees with the curve
constexpr double kAgreeWeight = 0.3;    // Tukey's weight of a site that agrees, at least

class EdgeAssociation {
 public:
  // For a curve of so many slots, and up to so many sites; nothing is allocated afterwards.
  void reserve(int slots, std::size_t sites);
  // No site counts as lonely: the curve has moved as a whole.
  void forgetLonely();
  // Whether the last dropLonely() took the say from the sites of this slot.
  bool isLonely(int slot) const { return lonely_[static_cast<std::size_t>(slot)] != 0; }

  // Of the edges near a site, the one that looks most like it, the nearer the better. `range`, px, was searched.
  // `moved`: px along its normal, how far the curve has left each site since; empty: the sites lie on it.
  void choose(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates, double range,
              const std::vector<double>& moved = {});
  const std::vector<robust::Row>& rows() const { return rows_; }
  // The site that a row belongs to.
  std::size_t siteOf(std::size_t row) const { return row_site_[row]; }

  // Weights of the sites after the fit; returns how far the step moves the curve, px along the normal of any site.
  double settle(const std::vector<Site>& sites, const Eigen::VectorXd& step, const std::vector<double>& weights,
                double sigma);
  // Where the curve is covered, edges of what covers it agree here and there, and would pull it: a site counts only if
  // more of its neighbours agree, itself included, than would by chance. `stray`: edges per site, over `range` px
  // either side, that could be the curve's, its own included. True when an edge near the curve lost or regained its
  // say, which the next fit will show.
  bool dropLonely(const std::vector<Site>& sites, double stray, double range);

  void clear() { findings_.clear(); }
  const std::vector<SiteFinding>& findings() const { return findings_; }
  // Of a site that has a weight.
  const EdgeLooks& looks(std::size_t site) const { return looks_[site]; }

 private:
  std::vector<SiteFinding> findings_;
  std::vector<EdgeLooks> looks_;
  std::vector<robust::Row> rows_;
  std::vector<std::size_t> row_site_;
  std::vector<char> lonely_;  // of each slot
  std::vector<int> seen_;     // sites up to each one that agree, and that lie in the image
};

// Of the candidates, the one with the largest weight, that of one at the end of the range being 0; -1 where none has
// any. The curve lies `moved` px from the site.
int bestOf(const WeightedCandidates& candidates, double range, double moved);

// How far the curve moves at the site, px along its normal.
double displacement(const Site& site, const Eigen::VectorXd& step);

}  // namespace laparoscope_servo::features
