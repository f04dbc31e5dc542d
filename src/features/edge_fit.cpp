#include "laparoscope_servo/features/edge_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "features/chance.h"
#include "features/coarse_motion.h"
#include "features/edge_search.h"
#include "laparoscope_servo/robust/irls.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kCoarseSites = 64;
constexpr double kCoarseStep = 2.0;  // px between samples
// The fine stage: how far it searches, px, round by round, until a round moves the curve by less than kSettled.
constexpr double kFineRange[] = {6.0, 3.0, 2.0, 2.0};
constexpr double kClose = 0.7;  // of the coarse stage's score: the first round is left out
constexpr double kSettled = 0.05;
constexpr double kMinSigma = 0.1;  // px: what sampling leaves of an edge without noise
// px: edges of a straight thing spread less about its line. What is gathered from a texture spreads more: where less
// than kMostlySeen of the sites agree, less is allowed.
constexpr double kMaxSigma = 1.5;
constexpr double kMaxSigmaOfFew = 0.7;
constexpr double kMostlySeen = 0.6;
constexpr double kTolerance = 1.0;  // px: an edge nearer than this agrees with the curve
constexpr double kAgree = 0.3;      // Tukey's weight of a site that agrees, at least
// Neighbours either side along the curve, and the share of them that has to agree: without stray edges, and at most.
constexpr int kNeighbours = 4;
constexpr double kLeastNeighbours = 0.33;
constexpr double kMostNeighbours = 0.7;
constexpr int kLeastSites = 8;
constexpr double kCorrelation = 8.0;  // px along the curve, over which edges err alike
constexpr double kLearn = 0.2;        // share of the looks that a new image adds to what is remembered
constexpr double kLeastLearnt = 0.5;  // of the sites that have to show the edge that is selected
// The means of contrast and levels over all sites, when all has to look as it did: they agree to a share of the larger
// one and some grey levels, but for a gain of the light.
constexpr float kMeanShare = 0.08f;
constexpr float kMeanLevels = 4.0f;
constexpr float kLeastGain = 0.7f;
constexpr double kAlikeShare = 0.7;  // of the sites used, when all has to look as it did

struct Memory {
  EdgeLooks looks;
  bool known = false;
};

enum class Sign { kRemembered, kPositive, kNegative, kAny };

}  // namespace

class EdgeFit::Implementation {
 public:
  explicit Implementation(const EdgeConfig& config) : config_(config) {}

  void reserve(const Curve& curve) {
    const int slots = curve.slots(), rows = config_.max_sites + 16;
    like_slots_ = curve.likeSlots();
    memory_.assign(static_cast<std::size_t>(slots), Memory());
    lonely_.assign(static_cast<std::size_t>(slots), false);
    const std::size_t size = static_cast<std::size_t>(rows);
    sites_.reserve(size);
    candidates_.resize(size);
    chosen_.resize(size);
    findings_.reserve(size);
    rows_.reserve(size);
    row_site_.reserve(size);
    seen_.reserve(2 * (size + 1));
    coarse_.reserve(rows);
    irls_.reserve(curve.parameters(), rows);
    information_.setZero(curve.parameters(), curve.parameters());
    mean_.setZero(curve.parameters());
    covariance_.setZero(curve.parameters(), curve.parameters());
  }

  EdgeReport learn(const cv::Mat& image, Curve& curve, double range) {
    reserve(curve);
    // Which side is the brighter one; a curve over a background of both kinds comes last. Where pieces do not look
    // alike, each has a side of its own.
    double best = 0.0;
    Sign sign = Sign::kAny;
    const bool alike = like_slots_ >= curve.slots();
    for (const Sign tried : {Sign::kPositive, Sign::kNegative, Sign::kAny}) {
      if (!alike && tried != Sign::kAny) continue;
      sign_ = tried;
      const double score = searched(image, curve, range).score * (tried == Sign::kAny ? 0.7 : 1.0);
      if (score > best) {
        best = score;
        sign = tried;
      }
    }
    sign_ = sign;
    EdgeReport report = run(image, curve, curve, range);
    sign_ = Sign::kRemembered;
    if (report.reason == Reason::kNone) judge(curve, range, kLeastLearnt, report);
    if (report.reason == Reason::kNone) remember(1.0);
    return report;
  }

  EdgeReport fit(const cv::Mat& image, const Curve& expected, Curve& curve, double range, bool returning,
                 double surprise) {
    sign_ = Sign::kRemembered;
    EdgeReport report = run(image, expected, curve, range);
    if (report.reason != Reason::kNone) return report;
    judge(curve, range, returning ? config_.min_return_share : config_.min_share, report);
    if (report.reason == Reason::kNone && (returning || jump_ > surprise) && !looksAsItDid(report.used)) {
      report.reason = Reason::kJump;
    }
    return report;
  }

  void remember(double share) {
    const float part = static_cast<float>(share);
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (!(findings_[i].weight >= kAgree)) continue;
      Memory& memory = memory_[static_cast<std::size_t>(sites_[i].slot)];
      const EdgeLooks& now = chosen_[i];
      if (!memory.known) memory = {now, true};
      memory.looks.contrast += part * (now.contrast - memory.looks.contrast);
      memory.looks.behind += part * (now.behind - memory.looks.behind);
      memory.looks.ahead += part * (now.ahead - memory.looks.ahead);
    }
  }

  const std::vector<SiteFinding>& findings() const { return findings_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  double jump() const { return jump_; }

 private:
  // Of the slot itself, else of the nearest one that is known and looks alike.
  const EdgeLooks* remembered(int slot) const {
    const int slots = static_cast<int>(memory_.size());
    for (int d = 0; d < std::min(slots, like_slots_ + 1); ++d) {
      for (const int s : {slot - d, slot + d}) {
        if (s >= 0 && s < slots && memory_[static_cast<std::size_t>(s)].known) {
          return &memory_[static_cast<std::size_t>(s)].looks;
        }
      }
    }
    return nullptr;
  }

  float weight(const EdgeLooks* memory, const EdgeLooks& looks) const {
    if (sign_ == Sign::kRemembered && memory != nullptr) {
      return similarity(looks, *memory, static_cast<float>(config_.min_similarity));
    }
    if (sign_ == Sign::kPositive && looks.contrast < 0.0f) return 0.0f;
    if (sign_ == Sign::kNegative && looks.contrast > 0.0f) return 0.0f;
    const float contrast = std::abs(looks.contrast);
    return contrast / (contrast + 4.0f * static_cast<float>(config_.min_contrast));
  }

  void look(const cv::Mat& image, const EdgeWindow& window) {
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      WeightedCandidates& candidates = candidates_[i];
      search_.find(image, sites_[i], window, config_.min_contrast, candidates.found);
      const EdgeLooks* memory = candidates.found.count > 0 ? remembered(sites_[i].slot) : nullptr;
      for (int k = 0; k < candidates.found.count; ++k) {
        const std::size_t at = static_cast<std::size_t>(k);
        candidates.weight[at] = weight(memory, candidates.found.at[at].looks);
      }
    }
  }

  CoarseResult searched(const cv::Mat& image, const Curve& curve, double range) {
    curve.sites(config_.spacing, std::min(kCoarseSites, config_.max_sites), sites_);
    look(image, {range, kCoarseStep});
    // How many edges a site has to choose from.
    int matching = 0, looking = 0;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (sites_[i].probe || !candidates_[i].found.inside) continue;
      ++looking;
      for (int k = 0; k < candidates_[i].found.count; ++k) {
        matching += candidates_[i].weight[static_cast<std::size_t>(k)] > 0.0f ? 1 : 0;
      }
    }
    matching_ = looking > 0 ? static_cast<double>(matching) / looking : 0.0;
    return coarse_.find(sites_, candidates_, range);
  }

  // Of the edges near a site, the one that looks most like it, the nearer the better.
  void choose(double range) {
    rows_.clear();
    row_site_.clear();
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const WeightedCandidates& all = candidates_[i];
      int best = -1;
      double best_value = 0.0;
      for (int k = 0; k < all.found.count; ++k) {
        const std::size_t at = static_cast<std::size_t>(k);
        const double t = static_cast<double>(all.found.at[at].offset) / (range + 1.0);
        const double value = static_cast<double>(all.weight[at]) * (1.0 - t * t);
        if (value > best_value) {
          best_value = value;
          best = k;
        }
      }
      findings_[i] = {sites_[i].point, sites_[i].point, 0.0, all.found.inside, sites_[i].probe, sites_[i].slot};
      if (best < 0) continue;
      const EdgeCandidate& candidate = all.found.at[static_cast<std::size_t>(best)];
      chosen_[i] = candidate.looks;
      findings_[i].edge = sites_[i].point + static_cast<double>(candidate.offset) * sites_[i].normal;
      robust::Row row;
      row.first = sites_[i].first;
      row.count = sites_[i].count;
      row.a = sites_[i].jacobian;
      row.b = static_cast<double>(candidate.offset);
      row.weight = sites_[i].probe || lonely_[static_cast<std::size_t>(sites_[i].slot)] ? 0.0 : 1.0;
      rows_.push_back(row);
      row_site_.push_back(i);
    }
  }

  EdgeReport run(const cv::Mat& image, const Curve& expected, Curve& curve, double range) {
    EdgeReport report;
    report.reason = Reason::kUndetermined;
    const CoarseResult coarse = searched(image, curve, range);
    jump_ = coarse.largest;
    if (!(coarse.score > 0.0)) {
      report.reason = Reason::kTooFewSites;
      findings_.clear();
      return report;
    }
    curve.transform(coarse.motion);
    std::fill(lonely_.begin(), lonely_.end(), false);
    robust::IrlsConfig irls;
    irls.min_sigma = kMinSigma;
    irls.min_step = 1e-3;
    irls.max_iterations = 10;
    double moved = 0.0;
    // Where the whole curve moves alike the coarse stage has come close.
    for (std::size_t round = coarse.share > kClose ? 1 : 0; round < std::size(kFineRange); ++round) {
      const double fine = kFineRange[round];
      curve.sites(config_.spacing, config_.max_sites, sites_);
      findings_.resize(sites_.size());
      look(image, {fine, 1.0});
      choose(fine);
      curve.known(expected, fine, information_, mean_);
      const robust::IrlsResult solved = irls_.solve(curve.parameters(), rows_, irls, information_, mean_);
      if (!solved.solved) return report;
      report.sigma = solved.sigma;
      moved = settle(report.sigma);
      dropLonely(range);
      curve.move(irls_.x());
      if (!curve.isSound()) {
        report.reason = Reason::kShape;
        return report;
      }
      if (moved < kSettled && fine < kFineRange[0]) break;
    }
    report.reason = Reason::kNone;
    return report;
  }

  // Weights and distances after the step; how far it moves the curve, px.
  double settle(double sigma) {
    double largest = 0.0;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const double step = along(sites_[i]);
      if (!sites_[i].probe) largest = std::max(largest, std::abs(step));
      findings_[i].point += step * sites_[i].normal;
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const std::size_t i = row_site_[r];
      const double error = std::abs(rows_[r].b - along(sites_[i]));
      const bool near = error < std::max(kTolerance, 2.0 * sigma) && error < 2.0 * kTolerance;
      findings_[i].weight = near ? std::max(irls_.weights()[r], 0.0) : 0.0;
    }
    return largest;
  }

  // Where the curve is covered, edges of what covers it agree here and there, and would pull it: a site counts only if
  // more of its neighbours agree, itself included, than would by chance.
  void dropLonely(double range) {
    const double chance = std::clamp((matching_ - 1.0) * 2.0 * kTolerance / range, 0.0, 1.0);
    const double least = std::clamp(kLeastNeighbours + chance, kLeastNeighbours, kMostNeighbours);
    const int count = static_cast<int>(findings_.size());
    seen_.assign(static_cast<std::size_t>(2 * (count + 1)), 0);
    for (int i = 0; i < count; ++i) {
      const SiteFinding& finding = findings_[static_cast<std::size_t>(i)];
      const bool counts = finding.inside && !finding.probe;
      seen_[static_cast<std::size_t>(2 * i + 2)] =
          seen_[static_cast<std::size_t>(2 * i)] + (counts && finding.weight >= kAgree ? 1 : 0);
      seen_[static_cast<std::size_t>(2 * i + 3)] = seen_[static_cast<std::size_t>(2 * i + 1)] + (counts ? 1 : 0);
    }
    for (int i = 0; i < count; ++i) {
      if (findings_[static_cast<std::size_t>(i)].probe) continue;
      const int from = std::max(0, std::min(i - kNeighbours, count - 1 - 2 * kNeighbours));
      const int to = std::min(count, std::max(i + kNeighbours, 2 * kNeighbours) + 1);
      const int agree = seen_[static_cast<std::size_t>(2 * to)] - seen_[static_cast<std::size_t>(2 * from)];
      const int inside = seen_[static_cast<std::size_t>(2 * to + 1)] - seen_[static_cast<std::size_t>(2 * from + 1)];
      lonely_[static_cast<std::size_t>(sites_[static_cast<std::size_t>(i)].slot)] = !(agree >= least * inside);
    }
    for (std::size_t i = 0; i < findings_.size(); ++i) {
      if (!findings_[i].probe && lonely_[static_cast<std::size_t>(sites_[i].slot)]) findings_[i].weight = 0.0;
    }
  }

  double along(const Site& site) const {
    const int unknowns = static_cast<int>(irls_.x().size());
    double sum = 0.0;
    for (int k = 0; k < site.count; ++k) {
      sum += site.jacobian[static_cast<std::size_t>(k)] * irls_.x()[(site.first + k) % unknowns];
    }
    return sum;
  }

  double variance(const Site& site) const {
    const int unknowns = static_cast<int>(covariance_.rows());
    double sum = 0.0;
    for (int k = 0; k < site.count; ++k) {
      for (int l = 0; l < site.count; ++l) {
        sum += site.jacobian[static_cast<std::size_t>(k)] * site.jacobian[static_cast<std::size_t>(l)] *
               covariance_((site.first + k) % unknowns, (site.first + l) % unknowns);
      }
    }
    return sum;
  }

  void judge(const Curve& curve, double range, double min_share, EdgeReport& report) {
    covariance_ = irls_.covariance() * std::max(1.0, kCorrelation / config_.spacing);
    int sites = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (sites_[i].probe) continue;
      ++sites;
      worst = std::max(worst, variance(sites_[i]));
      if (!findings_[i].inside) continue;
      ++report.inside;
      report.used += findings_[i].weight >= kAgree ? 1 : 0;
    }
    report.share = report.inside > 0 ? static_cast<double>(report.used) / report.inside : 0.0;
    report.expected_error = std::sqrt(worst);
    Agreement agreement;
    agreement.sites = report.inside;
    agreement.agree = report.used;
    agreement.tolerance = kTolerance;
    agreement.strays = std::max(0.0, matching_ - report.share);
    agreement.range = range;
    agreement.freedoms = curve.parameters();
    agreement.independent = std::min(1.0, config_.spacing / kCorrelation);
    report.evidence = evidence(agreement);
    if (report.inside < kLeastSites) {
      report.reason = Reason::kOutside;
    } else if (!(report.share >= min_share) || report.used < kLeastSites) {
      report.reason = Reason::kTooFewSites;
    } else if (!(report.sigma <= (report.share < kMostlySeen ? kMaxSigmaOfFew : kMaxSigma)) || !isNoChance(agreement)) {
      report.reason = Reason::kChance;
    } else if (!(report.expected_error <= config_.max_error)) {
      report.reason = Reason::kUncertain;
    }
  }

  // One by one, and all of them together, which tells smaller differences.
  bool looksAsItDid(int used) const {
    int alike = 0;
    EdgeLooks now, before;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (sites_[i].probe || !findings_[i].inside || !(findings_[i].weight >= kAgree)) continue;
      const EdgeLooks* memory = remembered(sites_[i].slot);
      if (memory == nullptr) continue;
      alike += looksAlike(chosen_[i], *memory) ? 1 : 0;
      add(chosen_[i], used, now);
      add(*memory, used, before);
    }
    // A gain of the light is borne; contrast and both sides have to follow it alike.
    const float gain = (now.behind + now.ahead) / std::max(1.0f, before.behind + before.ahead);
    const auto near = [gain](float a, float b) {
      return std::abs(a - gain * b) < kMeanShare * std::max(a, gain * b) + kMeanLevels;
    };
    return alike >= kAlikeShare * used && gain > kLeastGain && gain < 1.0f / kLeastGain &&
           near(std::abs(now.contrast), std::abs(before.contrast)) && near(now.behind, before.behind) &&
           near(now.ahead, before.ahead);
  }

  static void add(const EdgeLooks& looks, int count, EdgeLooks& mean) {
    const float share = 1.0f / static_cast<float>(count);
    mean.contrast += share * looks.contrast;
    mean.behind += share * looks.behind;
    mean.ahead += share * looks.ahead;
  }

  EdgeConfig config_;
  EdgeSearch search_;
  CoarseMotion coarse_;
  robust::Irls irls_;
  std::vector<Memory> memory_;
  std::vector<char> lonely_;  // of each slot
  int like_slots_ = 0;
  Sign sign_ = Sign::kRemembered;
  std::vector<Site> sites_;
  std::vector<WeightedCandidates> candidates_;
  std::vector<EdgeLooks> chosen_;
  std::vector<SiteFinding> findings_;
  std::vector<robust::Row> rows_;
  std::vector<std::size_t> row_site_;
  Eigen::MatrixXd information_, covariance_;
  Eigen::VectorXd mean_;
  std::vector<int> seen_;  // sites up to each one that agree, and that lie in the image
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
