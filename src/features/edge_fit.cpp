#include "laparoscope_servo/features/edge_fit.h"

#include <algorithm>
#include <iterator>

#include "laparoscope_servo/features/coarse_motion.h"
#include "laparoscope_servo/features/edge_association.h"
#include "laparoscope_servo/features/edge_memory.h"
#include "laparoscope_servo/features/edge_search.h"
#include "laparoscope_servo/features/edge_verdict.h"
#include "laparoscope_servo/robust/irls.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kCoarseSites = 64;
constexpr double kCoarseStep = 2.0;  // px between samples
// The fine stage: how far it searches, px, round by round, until a round moves the curve by less than kSettled.
constexpr double kFineRange[] = {6.0, 3.0, 2.0, 2.0};
constexpr double kClose = 0.7;        // of the coarse stage's score: the first round is left out
constexpr double kSettled = 0.3;      // an edge is found as well from there
constexpr double kMinSigma = 0.1;     // px: what sampling leaves of an edge without noise
constexpr float kLearn = 0.2f;        // share of the looks that a new image adds to what is remembered
constexpr double kLeastLearnt = 0.5;  // of the sites that have to show the edge that is selected

}  // namespace

class EdgeFit::Implementation {
 public:
  explicit Implementation(const EdgeConfig& config) : config_(config) {}

  EdgeReport learn(const cv::Mat& image, Curve& curve, double range) {
    reserve(curve);
    // Which side is the brighter one; a curve over a background of both kinds comes last. Where pieces do not look
    // alike, each has a side of its own.
    const bool alike = curve.likeSlots() >= curve.slots();
    double best = 0.0;
    EdgeSign sign = EdgeSign::kAny;
    for (const EdgeSign tried : {EdgeSign::kPositive, EdgeSign::kNegative, EdgeSign::kAny}) {
      if (!alike && tried != EdgeSign::kAny) continue;
      sign_ = tried;
      const double score = searched(image, curve, range).score * (tried == EdgeSign::kAny ? 0.7 : 1.0);
      if (score > best) {
        best = score;
        sign = tried;
      }
    }
    sign_ = sign;
    EdgeReport report = run(image, curve, curve, range);
    sign_ = EdgeSign::kRemembered;
    if (report.reason == Reason::kNone) believe(curve, range, kLeastLearnt, report);
    if (report.reason == Reason::kNone) remember(1.0f);
    return report;
  }

  EdgeReport fit(const cv::Mat& image, const Curve& expected, Curve& curve, double range, bool returning,
                 double surprise) {
    sign_ = EdgeSign::kRemembered;
    EdgeReport report = run(image, expected, curve, range);
    if (report.reason != Reason::kNone) return report;
    believe(curve, range, returning ? config_.min_return_share : config_.min_share, report);
    if (report.reason == Reason::kNone && (returning || !(jump_ <= surprise)) && !looksAsItDid(report.used)) {
      report.reason = Reason::kJump;
    }
    return report;
  }

  void remember(float share) {
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (agrees(i)) memory_.learn(sites_[i].slot, association_.looks(i), share);
    }
  }

  const std::vector<SiteFinding>& findings() const { return association_.findings(); }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  double jump() const { return jump_; }

 private:
  void reserve(const Curve& curve) {
    const int rows = config_.max_sites + 16;
    const std::size_t size = static_cast<std::size_t>(rows);
    memory_.reset(curve.slots(), curve.likeSlots());
    sites_.reserve(size);
    candidates_.resize(size);
    association_.reserve(curve.slots(), size);
    coarse_.reserve(rows);
    irls_.reserve(curve.parameters(), rows);
    information_.setZero(curve.parameters(), curve.parameters());
    mean_.setZero(curve.parameters());
    covariance_.setZero(curve.parameters(), curve.parameters());
  }

  bool agrees(std::size_t site) const { return association_.findings()[site].weight >= kAgreeWeight; }

  float weight(const EdgeLooks* memory, const EdgeLooks& looks) const {
    if (sign_ == EdgeSign::kRemembered && memory != nullptr) {
      return similarity(looks, *memory, static_cast<float>(config_.min_similarity));
    }
    if (sign_ == EdgeSign::kPositive && looks.contrast < 0.0f) return 0.0f;
    if (sign_ == EdgeSign::kNegative && looks.contrast > 0.0f) return 0.0f;
    const float contrast = std::abs(looks.contrast);
    return contrast / (contrast + 4.0f * static_cast<float>(config_.min_contrast));
  }

  // `probes`: also beyond the curve's ends.
  void look(const cv::Mat& image, const EdgeWindow& window, bool probes) {
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      WeightedCandidates& candidates = candidates_[i];
      candidates.found.count = 0;
      if (sites_[i].probe && !probes) continue;
      search_.find(image, sites_[i], window, config_.min_contrast, candidates.found);
      const EdgeLooks* memory = candidates.found.count > 0 ? memory_.find(sites_[i].slot) : nullptr;
      for (int k = 0; k < candidates.found.count; ++k) {
        const std::size_t at = static_cast<std::size_t>(k);
        candidates.weight[at] = weight(memory, candidates.found.at[at].looks);
      }
    }
  }

  CoarseResult searched(const cv::Mat& image, const Curve& curve, double range) {
    curve.sites(config_.spacing, std::min(kCoarseSites, config_.max_sites), sites_);
    look(image, {range, kCoarseStep, 2}, false);
    // How many edges a site has to choose from.
    int matching = 0;
    looking_ = 0;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (sites_[i].probe || !candidates_[i].found.inside) continue;
      ++looking_;
      for (int k = 0; k < candidates_[i].found.count; ++k) {
        matching += candidates_[i].weight[static_cast<std::size_t>(k)] > 0.0f ? 1 : 0;
      }
    }
    matching_ = looking_ > 0 ? static_cast<double>(matching) / looking_ : 0.0;
    return coarse_.find(sites_, candidates_, range);
  }

  EdgeReport run(const cv::Mat& image, const Curve& expected, Curve& curve, double range) {
    EdgeReport report;
    report.reason = Reason::kUndetermined;
    const CoarseResult coarse = searched(image, curve, range);
    jump_ = coarse.largest;
    if (!(coarse.score > 0.0)) {
      report.reason = looking_ > 0 ? Reason::kTooFewSites : Reason::kOutside;
      association_.clear();
      return report;
    }
    curve.transform(coarse.motion);
    association_.forgetLonely();
    robust::IrlsConfig irls;
    irls.min_sigma = kMinSigma;
    irls.min_step = 1e-2;
    irls.start_sigma = curve.deformation();
    irls.max_iterations = 12;
    // Where the whole curve moves alike the coarse stage has come close.
    for (std::size_t round = coarse.share > kClose ? 1 : 0; round < std::size(kFineRange); ++round) {
      const double fine = kFineRange[round];
      curve.sites(config_.spacing, config_.max_sites, sites_);
      look(image, {fine, 1.0, 1}, true);
      association_.choose(sites_, candidates_, fine);
      curve.known(expected, fine, information_, mean_);
      const robust::IrlsResult solved = irls_.solve(curve.parameters(), association_.rows(), irls, information_, mean_);
      if (!solved.solved) return report;
      report.sigma = solved.sigma;
      const double moved = association_.settle(sites_, irls_.x(), irls_.weights(), report.sigma);
      const bool changed = association_.dropLonely(sites_, matching_, range);
      curve.move(irls_.x());
      if (!curve.isSound()) {
        report.reason = Reason::kShape;
        return report;
      }
      if (moved < kSettled && !changed && fine < kFineRange[0]) break;
      irls.start_sigma = std::min(irls.start_sigma, kSettled);  // what deformed has been followed
    }
    report.reason = Reason::kNone;
    return report;
  }

  void believe(const Curve& curve, double range, double min_share, EdgeReport& report) {
    covariance_ = irls_.covariance() * correlation(config_.spacing);
    judge({sites_, findings(), covariance_, curve.parameters(), curve.deformation() > 0.0, range, matching_}, config_,
          min_share, report);
  }

  bool looksAsItDid(int used) const {
    LooksComparison comparison;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (sites_[i].probe || !findings()[i].inside || !agrees(i)) continue;
      const EdgeLooks* memory = memory_.find(sites_[i].slot);
      if (memory != nullptr) comparison.add(association_.looks(i), *memory);
    }
    return comparison.isAlike(used);
  }

  EdgeConfig config_;
  EdgeSearch search_;
  CoarseMotion coarse_;
  EdgeMemory memory_;
  EdgeAssociation association_;
  robust::Irls irls_;
  EdgeSign sign_ = EdgeSign::kRemembered;
  std::vector<Site> sites_;
  std::vector<WeightedCandidates> candidates_;
  Eigen::MatrixXd information_, covariance_;
  Eigen::VectorXd mean_;
  int looking_ = 0;        // sites of the coarse stage in the image
  double matching_ = 0.0;  // edges per site, within the range, that could be the curve's
  double jump_ = 0.0;
};

EdgeFit::EdgeFit(const EdgeConfig& config) : implementation_(std::make_unique<Implementation>(config)) {}
EdgeFit::~EdgeFit() = default;
EdgeFit::EdgeFit(EdgeFit&&) noexcept = default;
EdgeFit& EdgeFit::operator=(EdgeFit&&) noexcept = default;

EdgeReport EdgeFit::learn(const cv::Mat& image, Curve& curve, double range) {
  return implementation_->learn(image, curve, range);
}

EdgeReport EdgeFit::fit(const cv::Mat& image, const Curve& expected, Curve& curve, double range, bool returning,
                        double surprise) {
  return implementation_->fit(image, expected, curve, range, returning, surprise);
}

void EdgeFit::remember() {
  implementation_->remember(kLearn);
}

const std::vector<SiteFinding>& EdgeFit::findings() const {
  return implementation_->findings();
}

const Eigen::MatrixXd& EdgeFit::covariance() const {
  return implementation_->covariance();
}

double EdgeFit::jump() const {
  return implementation_->jump();
}

}  // namespace laparoscope_servo::features
