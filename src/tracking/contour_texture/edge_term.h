// The edges of a contour as a part of ESM's minimisation: what the edge stage finds near the contour, one equation for
// each site, with a robust scale of their own.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/coarse_motion.h"
#include "laparoscope_servo/features/edge_association.h"
#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/features/edge_memory.h"
#include "laparoscope_servo/features/edge_search.h"
#include "tracking/contour_texture/outline.h"
#include "tracking/esm/extra_term.h"

namespace laparoscope_servo::tracking {

class EdgeTerm : public ExtraTerm {
 public:
  explicit EdgeTerm(const features::EdgeConfig& config) : config_(config) {}

  // Takes the contour, and what its edges look like in the reference image.
  void learn(const cv::Mat& image, const Outline& outline);

  // Looks for edges within `range` px along the normals of the contour at `g`, at `most` sites at most. What the image
  // shows there holds for add() until the next call.
  void look(const cv::Mat& image, const Eigen::Matrix3d& g, double range, int most);

  // Of each site the edge that looks most like the one remembered, the nearer to the contour at `g` the better; Tukey's
  // weights, by the scale of these distances (survey, appendix; (12), (13)). And that the light hardly changes from
  // image to image, which a thing without texture does not show.
  void add(const Eigen::Matrix3d& g, double gain, Matrix10d& information, Vector10d& score) override;

  // Of the light in the last image that was believed.
  void expectGain(double gain) { expected_gain_ = gain; }

  // The similarity that brings most sites of the last look() onto edges, and the share of them; identity and 0 where
  // none does.
  features::CoarseResult coarse(double range) { return coarse_.find(sites_, candidates_, range); }

  // Takes the say from sites whose neighbours do not agree with the contour at `g`: it is covered there. True when so
  // many of those that agreed lost it that the contour should be aligned again.
  bool gate(const Eigen::Matrix3d& g);
  // No site is covered.
  void forget() { association_.forgetLonely(); }

  // Whether the edges that the last gate() found agree with the contour there, whose G has the covariance `covariance`
  // (of x, see MotionPrior).
  features::EdgeReport judge(const Matrix8d& covariance, double min_share);

  // Takes the looks of the sites that agreed into the memory.
  void remember();

  const std::vector<features::SiteFinding>& findings() const { return association_.findings(); }
  double sigma() const { return sigma_; }  // px, robust scale of the last add() or gate()

 private:
  struct Equation {
    std::size_t site;
    double away;  // px, of its edge from the contour along its normal
  };

  void choose(const Eigen::Matrix3d& g);
  // px, of the contour at `g` from the site along its normal.
  double movedFrom(const features::Site& site, const Eigen::Matrix3d& g) const;
  // px, robust; reorders the magnitudes.
  static double scaleOf(std::vector<double>& magnitudes);

  features::EdgeConfig config_;
  Outline outline_;
  features::EdgeSearch search_;
  features::EdgeMemory memory_;
  features::CoarseMotion coarse_;
  features::EdgeAssociation association_;
  double range_ = 0.0;     // px, of the last look()
  double matching_ = 0.0;  // edges per site within it, that could be the contour's
  std::vector<features::Site> sites_;
  std::vector<features::WeightedCandidates> candidates_;
  std::vector<Equation> equations_;  // of the last add()
  std::vector<double> moved_;        // px, of the contour from each site along its normal
  std::vector<double> errors_;       // px, of the rows of the association that have a say
  std::vector<double> weights_;      // Tukey's, of each row
  Eigen::VectorXd no_step_ = Eigen::VectorXd::Zero(8);
  Eigen::MatrixXd covariance_;
  double sigma_ = 0.0;
  double expected_gain_ = 1.0;
};

}  // namespace laparoscope_servo::tracking
