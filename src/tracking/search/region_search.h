// Searches a region of interest (ROI) that was lost: at one place after another, until what is aligned there can be
// believed.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/align/quality.h"
#include "tracking/align/region_aligner.h"
#include "tracking/search/confirmation.h"
#include "tracking/search/feature_search.h"
#include "tracking/views/keyframes.h"

namespace laparoscope_servo::tracking {

// An alignment with an image, and why it is not believed; empty when it is.
struct Attempt {
  Evidence evidence;
  std::string doubt;
};

class RegionSearch {
 public:
  // With a lens images are raw; homographies and the ROI are in rectified pixels.
  explicit RegionSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // `aligner` has the image and its ROI for the reference.
  void setReference(const cv::Mat& image, RegionAligner& aligner);
  // The ROI was tracked at `g`, as `aligner` has just seen it: stores what the image shows of it, when it is clear, and
  // new.
  void keepView(const cv::Mat& image, const Evidence& seen, const Eigen::Matrix3d& g, RegionAligner& aligner);

  // The ROI has been lost: the search starts.
  void restart();

  struct Found {
    Attempt attempt;             // the last one; without a doubt when the ROI was found
    bool where_carried = false;  // the attempt was the one at `carried`
  };
  // Aligns with the image what `aligner` has for the reference, from a place to start from.
  using Try = std::function<Attempt(const EsmState& start)>;
  // One image. `last`: the last estimate that was believed; `carried`: the same, moved by what somebody else than the
  // images knows.
  Found search(const cv::Mat& image, RegionAligner& aligner, const EsmState& last,
               const std::optional<Eigen::Matrix3d>& carried, const Try& attempt);

  // What was found waits there until it is confirmed.
  Confirmation& confirmation() { return confirmation_; }
  const Confirmation& confirmation() const { return confirmation_; }

 private:
  std::string doubtOf(const Attempt& found, const RegionAligner& aligner) const;
  std::vector<Eigen::Matrix3d> furtherPlaces(const cv::Mat& image, const RegionAligner& aligner,
                                             const Eigen::Matrix3d& last);
  std::vector<Eigen::Matrix3d> byFeatures(const cv::Mat& image, const RegionAligner& aligner);
  std::vector<Eigen::Matrix3d> byCorrelation(const cv::Mat& image, const RegionAligner& aligner,
                                             const Eigen::Matrix3d& last) const;

  SearchConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  Keyframes keyframes_;
  FeatureSearch feature_search_;
  Confirmation confirmation_;
  unsigned turn_ = 0;  // images searched since the ROI was lost
};

}  // namespace laparoscope_servo::tracking
