// Searches a region of interest (ROI) that was lost: says where to align it, one place after another. What it takes to
// find such places is spread over as many images as the budget asks for.
#pragma once

#include <Eigen/Core>
#include <deque>
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
#include "tracking/search/search_budget.h"
#include "tracking/search/start_check.h"
#include "tracking/views/keyframes.h"

namespace laparoscope_servo::tracking {

// An alignment with an image, and why it is not believed; empty when it is.
struct Attempt {
  Evidence evidence;
  std::string doubt;
};

// What suggested a place.
enum class Suggestion {
  kConfirmation,  // it was found there in the image before
  kCarried,       // somebody else than the images knows how it moved
  kLast,          // it was there when it was last believed
  kFeatures,
  kCorrelation,
};

struct SearchPlace {
  EsmState start;
  Suggestion by = Suggestion::kLast;
};

class RegionSearch {
 public:
  // With a lens images are raw; homographies and the ROI are in rectified pixels.
  explicit RegionSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // `aligner` has the image and its ROI for the reference.
  void setReference(const cv::Mat& image, RegionAligner& aligner);
  // The ROI was tracked at `g`, as `aligner` has just seen it at `stamp` [s]: stores what the image shows of it, when
  // it is clear, and new, or none was stored for some time.
  void keepKeyframe(const cv::Mat& image, double stamp, const Evidence& seen, const Eigen::Matrix3d& g,
                    RegionAligner& aligner);

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config);

  // The ROI has been lost: the search starts.
  void restart();

  // The next image. `last`: the last estimate that was believed; `carried`: the same, moved by what somebody else than
  // the images knows.
  void begin(const EsmState& last, const std::optional<Eigen::Matrix3d>& carried);
  // Where to align `aligner`'s reference with that image, likely places first; empty when there is no place left, or no
  // time. To be asked again after each attempt, until one is without a doubt.
  std::optional<SearchPlace> next(const cv::Mat& image, const RegionAligner& aligner);
  // The result of aligning at the place that next() returned last, with `aligner` as that alignment left it. True when
  // the result is accepted.
  bool judge(const Attempt& attempt, const RegionAligner& aligner);

  // The accepted attempt in this image; when there is none, the one with the highest correlation, which tells best why.
  const Attempt& best() const { return best_; }
  Suggestion suggestedBy() const { return best_by_; }

  // What was found waits there until it is confirmed.
  Confirmation& confirmation() { return confirmation_; }
  const Confirmation& confirmation() const { return confirmation_; }

 private:
  std::string whyNone() const;
  std::string doubtOf(const Attempt& found, const RegionAligner& aligner) const;
  std::optional<SearchPlace> nextSuggested(const cv::Mat& image);
  bool work(const cv::Mat& image, const RegionAligner& aligner);
  void suggest(const Eigen::Matrix3d& g, Suggestion by);
  double alignmentCost(int iterations) const;
  double slideCost() const;
  void slide(const RegionAligner& aligner);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  Keyframes keyframes_;
  std::optional<double> recent_stamp_;  // s, of the most recent keyframe; at first, of the first image
  FeatureSearch feature_search_;
  StartCheck start_check_;
  Confirmation confirmation_;

  // A pass over one image, which may take several: by points, then by correlation.
  bool passing_ = false;
  bool to_slide_ = false;
  CoarseImage coarse_;

  // The present image.
  SearchBudget budget_;
  EsmState last_;
  std::deque<SearchPlace> suggested_;  // those that there was no time for stay for the next one
  bool began_ = false;                 // a pass has begun in this image: a second one would find the same places
  bool worked_ = true;                 // a piece of a pass was done in this image
  bool hungry_ = false;                // none was done in the image before: this image begins with one
  Suggestion tried_ = Suggestion::kLast;
  double likeliest_ = 0.0;  // correlation of the places that were looked at
  bool aligned_ = false;    // one of them was
  Attempt best_;
  Suggestion best_by_ = Suggestion::kLast;
};

}  // namespace laparoscope_servo::tracking
