// Search for a lost region of interest (ROI): suggests places at which to align it, one after another. Finding such
// places is spread over as many images as the budget requires.
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
#include "tracking/search/feature_search.h"
#include "tracking/search/search_budget.h"
#include "tracking/search/start_check.h"
#include "tracking/views/keyframes.h"

namespace laparoscope_servo::tracking {

// An alignment with an image, and its rejection reason; empty if it is accepted.
struct Attempt {
  Evidence evidence;
  std::string doubt;
};

// The source of a suggested place.
enum class Suggestion {
  kConfirmation,  // the candidate of the last image
  kCarried,       // the last accepted estimate moved by the ego-motion
  kLast,          // the last accepted estimate
  kFeatures,
  kCorrelation,
};

struct SearchPlace {
  EsmState start;
  Suggestion by = Suggestion::kLast;
  AlignmentLimits limits = {};  // of an alignment there
  int resumed = 0;              // times that it was interrupted, and goes on in the next image
};

class RegionSearch {
 public:
  // With a lens images are raw; homographies and the ROI are in rectified pixels.
  explicit RegionSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // `aligner` must have this image and its ROI as its reference.
  void setReference(const cv::Mat& image, RegionAligner& aligner);
  // Call after `aligner` tracked the ROI at `g` in the image of `stamp` [s]. Stores a keyframe if the ROI is clearly
  // visible and the view is new, or if no most recent keyframe was stored for some time.
  void keepKeyframe(const cv::Mat& image, double stamp, const Evidence& seen, const Eigen::Matrix3d& g,
                    RegionAligner& aligner);

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config);

  // Starts the search, when the ROI has been lost.
  void restart();

  // Begins the next image. `last`: the last accepted estimate; `carried`: its G moved by the ego-motion; `awaited`: see
  // Confirmation.
  void begin(const EsmState& last, const std::optional<Eigen::Matrix3d>& carried,
             const std::optional<EsmState>& awaited = std::nullopt);
  // The next place at which to align `aligner`'s reference with the image, likely places first; empty if no place or no
  // budget is left. Call again after each attempt until one is accepted. What is left of the budget limits the work of
  // the alignment; if it does not suffice, the alignment goes on in the next image from where it is then.
  std::optional<SearchPlace> next(const cv::Mat& image, const RegionAligner& aligner);
  // Takes the result of the alignment at the place that next() returned last; `aligner` must be as that alignment left
  // it. Returns true if the result is accepted.
  bool judge(const Attempt& attempt, const RegionAligner& aligner);

  // The accepted attempt in this image; if there is none, the attempt with the highest correlation, for its reason.
  const Attempt& best() const { return best_; }
  Suggestion suggestedBy() const { return best_by_; }

 private:
  std::string whyNone() const;
  std::string doubtOf(const Attempt& found, const RegionAligner& aligner) const;
  std::optional<SearchPlace> nextSuggested(const cv::Mat& image);
  bool work(const cv::Mat& image, const RegionAligner& aligner);
  void suggest(const Eigen::Matrix3d& g, Suggestion by);
  double lookCost(const cv::Size& image, const Eigen::Matrix3d& g) const;
  double finestPixels() const;
  double iterationCost() const;
  double slideCost() const;
  void slide(const RegionAligner& aligner);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: no lens
  Keyframes keyframes_;
  std::optional<double> recent_stamp_;  // s, of the most recent keyframe; at first, of the first image
  FeatureSearch feature_search_;
  StartCheck start_check_;

  // State of a pass over one image, by points and then by correlation, which may last for several images.
  bool passing_ = false;
  bool to_slide_ = false;
  CoarseImage coarse_;

  // State of the present image.
  SearchBudget budget_;
  EsmState last_;
  std::deque<SearchPlace> suggested_;  // places not tried for want of budget stay for the next image
  bool began_ = false;                 // a pass has begun in this image; a second one would find the same places
  bool worked_ = true;                 // a piece of a pass was done in this image
  bool hungry_ = false;                // no piece was done in the last image: this image begins with one
  SearchPlace tried_;
  double likeliest_ = 0.0;  // largest correlation of the places that were checked
  bool aligned_ = false;    // an alignment was tried in this image
  Attempt best_;
  Suggestion best_by_ = Suggestion::kLast;
};

}  // namespace laparoscope_servo::tracking
