#include "model/model_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/pose_search.h"

namespace laparoscope_servo::model {

namespace {

constexpr std::size_t kTried = 12;
constexpr double kFitRange = 6.0;              // px: what the search leaves
constexpr double kSlack = 2.0 * M_PI / 180.0;  // what a fit may be off
constexpr double kSame = 6.0;                  // px between points of the model: two fits that have met
// Sites beyond these need no evidence of their own: what agrees by chance has at most 1.05 nats per site where there
// are up to 60 sites, at most 0.50 where there are more than 150, and at most 96 nats in all (bench_model_chance).
constexpr int kEnoughSites = 150;

// About the axis of the camera about which it is the largest, rad.
double turn(const Outline& from, const Outline& to) {
  return geometry::so3Log(to.pose().linear() * from.pose().linear().transpose()).cwiseAbs().maxCoeff();
}

}  // namespace

StartResult ModelStart::find(const cv::Mat& image, Outline& outline, features::EdgeFit& fit) {
  StartResult result;
  result.report.reason = features::Reason::kNotSeen;
  const PoseRange range{config_.start_rotation * M_PI / 180.0, config_.start_shift};
  // Its fields are as large as the model in the image, 30 MB at 1920x1080: they end with the start.
  PoseSearch search;
  const std::vector<PoseCandidate> candidates = search.find(image, outline, range, config_.edges.min_contrast, kTried);
  Outline best = outline;
  Occluders occluders(outline.model());
  for (const PoseCandidate& candidate : candidates) {
    Outline tried = outline;
    tried.setPose(candidate.camera_T_object);
    tried.forgetVisibility();
    tried.look(occluders);
    features::EdgeFit own(config_.edges);
    features::EdgeReport report = own.learn(image, tried, kFitRange);
    if (!tried.isSound()) continue;
    // Once more, with what is seen from where it has been found.
    tried.look(occluders);
    report = own.learn(image, tried, kFitRange);
    // Further away than a start may be: it is not what is looked for, however well it agrees.
    if (!tried.isSound() || turn(outline, tried) > range.rotation + kSlack) continue;
    if (!(report.share >= config_.start_share) && report.reason == features::Reason::kNone) {
      report.reason = features::Reason::kTooFewSites;
    }
    const bool met = result.report.evidence > 0.0 && best.apart(tried.pose()) < kSame;
    if (report.evidence > result.report.evidence) {
      if (!met) result.other_evidence = result.report.evidence;
      result.report = report;
      best = tried;
      fit = std::move(own);
    } else if (!met) {
      result.other_evidence = std::max(result.other_evidence, report.evidence);
    }
  }
  outline = best;
  if (result.report.reason == features::Reason::kNone &&
      !(result.report.evidence >= config_.start_evidence * std::min(result.report.inside, kEnoughSites))) {
    result.report.reason = features::Reason::kChance;
  }
  if (result.report.reason == features::Reason::kNone &&
      !(result.report.evidence - result.other_evidence >= config_.start_margin * result.report.inside)) {
    result.report.reason = features::Reason::kAmbiguous;
  }
  return result;
}

}  // namespace laparoscope_servo::model
