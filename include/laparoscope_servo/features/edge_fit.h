// One robust fit of a curve to the edges of an image, for every kind of curve: coarse motion, then iteratively
// reweighted least squares on what the edge stage finds, and whether to believe the outcome.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

struct EdgeReport {
  Reason reason = Reason::kNothingSelected;  // kNone: may be believed
  int inside = 0;                            // sites in the image
  int used = 0;                              // of them, that agree with the curve
  double share = 0.0;                        // used over inside
  double sigma = 0.0;                        // px, robust standard deviation of the edges about the curve
  // px along the normal, standard deviation at the worst site; of a curve that deforms, at the worst one that agrees.
  double expected_error = 0.0;
  // Minus the logarithm of how probable it is at most that, by chance, as many agree as closely: to compare curves of
  // one image.
  double evidence = 0.0;
};

class EdgeFit {
 public:
  // The configuration has to be valid.
  explicit EdgeFit(const EdgeConfig& config);
  ~EdgeFit();
  EdgeFit(EdgeFit&&) noexcept;
  EdgeFit& operator=(EdgeFit&&) noexcept;

  // Fits a curve that nothing is known of but where it is, within `range` px, and remembers its looks if the report
  // says that it may be believed. Allocates; what comes after does not, for curves of as many parameters and slots.
  EdgeReport learn(const cv::Mat& image, Curve& curve, double range);

  // Fits a curve whose looks are remembered, within `range` px of `expected`. `returning`: it was lost, more is asked
  // of it. `surprise`, px: when it lies further away than this it has to look as it did. `curve` is of the same kind,
  // and changed in any case.
  EdgeReport fit(const cv::Mat& image, const Curve& expected, Curve& curve, double range, bool returning,
                 double surprise);

  // Takes the looks of the sites that the last fit used into the memory.
  void remember();

  // Of the last fit.
  const std::vector<SiteFinding>& findings() const;
  // Of the curve's parameters, valid when the fit reached them: px^2 and products with their units.
  const Eigen::MatrixXd& covariance() const;
  // px, the largest along a normal between where the curve was expected and where the coarse stage found it.
  double jump() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::features
