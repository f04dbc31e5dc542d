#include "tracking/search/region_search.h"

#include <Eigen/LU>
#include <sstream>

#include "laparoscope_servo/image/warp.h"
#include "tracking/search/relocalisation.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kCandidates = 2;  // that are aligned, of each stage of the search
// A view is worth storing that was seen nearly whole, and clearly.
constexpr double kKeyframeVisible = 0.7;
constexpr double kKeyframeZncc = 0.85;

}  // namespace

RegionSearch::RegionSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config.search),
      lens_(lens),
      keyframes_(config.search.keyframes, lens),
      feature_search_(config, lens),
      confirmation_(config.quality) {}

void RegionSearch::setReference(const cv::Mat& image, RegionAligner& aligner) {
  keyframes_.setReference(image, aligner.roi(), aligner.weights());
}

void RegionSearch::keepView(const cv::Mat& image, const Evidence& seen, const Eigen::Matrix3d& g,
                            RegionAligner& aligner) {
  if (!(seen.visible_fraction >= kKeyframeVisible) || !(seen.zncc >= kKeyframeZncc)) return;
  if (config_.features && keyframes_.wants(g)) keyframes_.add(image, g, aligner.weights());
}

void RegionSearch::restart() {
  turn_ = 0;
  feature_search_.restart();
}

// What the last image suggested comes first, then where the ROI was last seen, then what the image itself suggests.
RegionSearch::Found RegionSearch::search(const cv::Mat& image, RegionAligner& aligner, const EsmState& last,
                                         const std::optional<Eigen::Matrix3d>& carried, const Try& attempt) {
  Found found;
  const auto tryAt = [&](const EsmState& light, const Eigen::Matrix3d& g) {
    EsmState start = light;
    start.g = g;
    aligner.startAfresh();
    found.attempt = attempt(start);
    if (found.attempt.doubt.empty()) found.attempt.doubt = doubtOf(found.attempt, aligner);
    return found.attempt.doubt.empty();
  };
  if (confirmation_.waiting() && tryAt(confirmation_.candidate(), confirmation_.expected())) return found;
  if (carried && tryAt(last, *carried)) {
    found.where_carried = true;
    return found;
  }
  if (tryAt(last, last.g)) return found;
  for (const Eigen::Matrix3d& g : furtherPlaces(image, aligner, last.g)) {
    if (tryAt(last, g)) break;
  }
  return found;
}

// A search asks at many places, so that one of them may pass by chance what a tracked region passes by right: more is
// asked.
std::string RegionSearch::doubtOf(const Attempt& found, const RegionAligner& aligner) const {
  const double detail = aligner.detail();
  std::ostringstream why;
  why.precision(3);
  if (found.evidence.esm.status != EsmStatus::kConverged) {
    why << "still moving where it was searched";
  } else if (!(detail >= config_.min_detail)) {
    why << "correlation of details " << detail << " where it was searched, expected at least " << config_.min_detail;
  }
  return why.str();
}

// What points suggest, or, in turn with them, what correlates anywhere in the image: one of both an image, so that the
// time is bounded.
std::vector<Eigen::Matrix3d> RegionSearch::furtherPlaces(const cv::Mat& image, const RegionAligner& aligner,
                                                         const Eigen::Matrix3d& last) {
  const bool features = config_.features && (!config_.correlation || turn_ % 2 == 0);
  ++turn_;
  if (features) return byFeatures(image, aligner);
  return config_.correlation ? byCorrelation(image, aligner, last) : std::vector<Eigen::Matrix3d>();
}

std::vector<Eigen::Matrix3d> RegionSearch::byFeatures(const cv::Mat& image, const RegionAligner& aligner) {
  std::vector<Eigen::Matrix3d> places;
  for (const FeatureCandidate& candidate : feature_search_.find(image, aligner.channels().weights[0], keyframes_)) {
    if (static_cast<int>(places.size()) < kCandidates) places.push_back(candidate.g);
  }
  return places;
}

std::vector<Eigen::Matrix3d> RegionSearch::byCorrelation(const cv::Mat& image, const RegionAligner& aligner,
                                                         const Eigen::Matrix3d& last) const {
  const int l = aligner.esm().levels() - 1;
  image::RegionPyramid whole;
  whole.build(image, cv::Rect(0, 0, image.cols, image.rows), l + 1, aligner.channels().weights[0]);
  const EsmLevel& level = aligner.esm().level(l);
  cv::Mat1f coarse = whole.level(l);
  Eigen::Matrix3d from_coarse = Eigen::Matrix3d::Identity();  // its first pixel to that of the image
  if (lens_) {
    const cv::Rect box = image::rectifiedBox(*lens_, image.size());
    from_coarse.topRightCorner<2, 1>() << box.x, box.y;
    Eigen::Matrix3d sampling = from_coarse;
    sampling.topLeftCorner<2, 2>() *= level.scale;
    const cv::Size size(static_cast<int>(box.width / level.scale) + 1, static_cast<int>(box.height / level.scale) + 1);
    coarse = cv::Mat1f(size);
    cv::Mat1f valid(size);
    image::warpBilinear(whole.level(l), sampling, *lens_, {cv::Point(0, 0), level.scale}, coarse, valid);
    coarse.setTo(0.0f, valid == 0.0f);
  }
  std::vector<Eigen::Matrix3d> places;
  for (const Candidate& candidate :
       searchByCorrelation(level.planes[0].value.view(), level.image_T_patch, coarse, level.scale, aligner.roi(),
                           from_coarse.inverse() * last, kCandidates)) {
    places.push_back(from_coarse * candidate.g);
  }
  return places;
}

}  // namespace laparoscope_servo::tracking
