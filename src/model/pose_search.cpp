#include "model/pose_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::model {

namespace {

constexpr int kFinest = 1;                     // level of the last refinement
constexpr double kCoarseRadius = 20.0;         // px of the model in the coarse field; the fine one has twice as many
constexpr double kTurn = 15.0 * M_PI / 180.0;  // from one orientation to the next; half of it moves edges by 2 px
constexpr double kGrowth = 1.13;               // from one size to the next
constexpr int kSites = 64;                     // of each orientation
constexpr int kPieceStep = 8;                  // hidden or not is asked of every eighth piece
constexpr int kFar = 5;                        // px of the coarse field: an edge further away than this says nothing
constexpr int kMostCost = 60;             // of a site that has no edge so near; the sums of all sites stay below 2^16
constexpr std::size_t kPlacesOfTurn = 2;  // of each orientation: two objects may look like the model
constexpr int kPlace = 8;                 // px of the coarse field: shifts as near as that are one place
constexpr std::size_t kRefined = 60;
constexpr int kIterations = 12;
constexpr double kWide = 6.0, kNarrow = 1.5;  // px of the fine field: the scale of what is astray, first and last
constexpr double kAgrees = 2.5;               // px of the fine field
constexpr double kApart = 2.5;                // px of the fine field: poses that are nearer to each other are the same
constexpr double kKnown = 20.0;               // px of the image: how far a refinement may move the model freely

double radiusInImage(const Outline& outline) {
  return outline.camera().fx * outline.model().radius / outline.centre().z();
}

// Turned from one pose to the other about each axis of the camera by no more than was asked for, and what the grid
// leaves.
bool isWithin(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double rotation) {
  const Eigen::Vector3d turned = geometry::so3Log(to.linear() * from.linear().transpose());
  return turned.cwiseAbs().maxCoeff() <= rotation + 0.5 * kTurn;
}

bool isBetter(const PoseCandidate& a, const PoseCandidate& b) {
  return a.score > b.score;
}

}  // namespace

std::vector<PoseCandidate> PoseSearch::find(const cv::Mat& image, const Outline& outline, const PoseRange& range,
                                            double min_contrast, std::size_t most) {
  const double radius = radiusInImage(outline);
  const Eigen::Vector2d centre = project(outline.camera(), outline.centre());
  if (!(radius > 0.0) || !std::isfinite(radius) || !centre.allFinite()) return {};  // before the casts
  const int level = std::clamp(static_cast<int>(std::lround(std::log2(radius / kCoarseRadius))), 1, 5);
  const double reach = (kGrowth + 0.1 + range.shift) * radius;
  const cv::Rect area(
      cv::Point(static_cast<int>(std::floor(centre.x() - reach)), static_cast<int>(std::floor(centre.y() - reach))),
      cv::Point(static_cast<int>(std::ceil(centre.x() + reach)), static_cast<int>(std::ceil(centre.y() + reach))));
  occluders_.reserve(outline.model());
  if ((area & cv::Rect({0, 0}, image.size())).empty()) return {};
  std::vector<PoseCandidate> all;
  coarse_.compute(image, area, level, min_contrast);
  fine_.compute(image, area, level - 1, min_contrast);
  scoreShifts(outline, range, all);
  const std::size_t refined = std::min(kRefined, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(refined), all.end(), isBetter);
  all.resize(refined);
  std::vector<PoseCandidate> best;
  refineBest(all, outline, range.rotation, most, best);
  // Down to where the fit to the image itself takes over: an edge of the model that is off by more than the fit's range
  // would be drawn to whatever else is near it.
  for (int finer = level - 2; finer >= kFinest; --finer) {
    fine_.compute(image, area, finer, min_contrast);
    all = best;
    refineBest(all, outline, range.rotation, most, best);
  }
  return best;
}

void PoseSearch::refineBest(std::vector<PoseCandidate>& all, const Outline& expected, double rotation, std::size_t most,
                            std::vector<PoseCandidate>& best) {
  Outline candidate = expected;
  for (PoseCandidate& one : all) {
    candidate.setPose(one.camera_T_object);
    one.score = refine(candidate, kKnown);
    one.camera_T_object = candidate.pose();
  }
  best.clear();
  std::sort(all.begin(), all.end(), isBetter);
  const double same = kApart / fine_.scale();
  for (const PoseCandidate& one : all) {
    if (best.size() == most || !(one.score > 0.0)) break;
    if (!isWithin(expected.pose(), one.camera_T_object, rotation)) continue;
    candidate.setPose(one.camera_T_object);
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const PoseCandidate& other) {
      return candidate.apart(other.camera_T_object) < same;
    });
    if (is_new) best.push_back(one);
  }
}

void PoseSearch::scoreShifts(const Outline& expected, const PoseRange& range, std::vector<PoseCandidate>& all) {
  const int reach = static_cast<int>(std::lround(range.shift * radiusInImage(expected) * coarse_.scale()));
  for (int k = 0; k < EdgeField::kBins; ++k) {
    cv::Mat1b& cost = cost_[static_cast<std::size_t>(k)];
    coarse_.distances(k).convertTo(cost, CV_8U, static_cast<double>(kMostCost) / kFar);
    cv::min(cost, kMostCost, cost);
  }
  const int turns = static_cast<int>(std::ceil(range.rotation / kTurn - 1e-9));
  const double turn = turns > 0 ? range.rotation / turns : 0.0;
  const Eigen::Vector3d centre = expected.centre();
  const Eigen::Vector2d middle = project(expected.camera(), centre);
  Outline outline = expected;
  for (int i = -turns; i <= turns; ++i) {
    for (int j = -turns; j <= turns; ++j) {
      for (int k = -turns; k <= turns; ++k) {
        Eigen::Isometry3d pose = expected.pose();
        pose.linear() = geometry::so3Exp(turn * Eigen::Vector3d(i, j, k)) * pose.linear();
        pose.translation() = centre - pose.linear() * expected.model().centre;
        outline.setPose(pose);
        outline.forgetVisibility();
        outline.look(occluders_, kPieceStep);
        outline.sites(1.0, kSites, sites_);
        if (sites_.empty()) continue;
        places_.clear();
        for (const features::Site& site : sites_) {
          places_.push_back({EdgeField::bin(site.normal), (site.point - middle) * coarse_.scale()});
        }
        std::array<PoseCandidate, kPlacesOfTurn> best;
        for (const double growth : {1.0 / kGrowth, 1.0, kGrowth}) {
          sumShifts(coarse_.toField(middle), growth, reach);
          for (PoseCandidate& place : best) {
            cv::Point shift;
            const int cost = leastShift(reach, shift);
            const double score = 1.0 - cost / (kMostCost * static_cast<double>(places_.size()));
            coverShift(reach, shift);
            if (!(score > place.score)) continue;
            place.score = score;
            outline.setPose(pose);
            Eigen::Matrix3d similarity = Eigen::Matrix3d::Identity();
            similarity.topLeftCorner<2, 2>() *= growth;
            similarity.topRightCorner<2, 1>() =
                (1.0 - growth) * middle + Eigen::Vector2d(shift.x, shift.y) / coarse_.scale();
            outline.transform(similarity);
            place.camera_T_object = outline.pose();
          }
        }
        for (const PoseCandidate& place : best) {
          if (place.score > 0.0) all.push_back(place);
        }
      }
    }
  }
}

void PoseSearch::sumShifts(const Eigen::Vector2d& centre, double growth, int reach) {
  const int side = 2 * reach + 1;
  sums_.assign(static_cast<std::size_t>(side * side), 0);
  for (const Place& place : places_) {
    const cv::Mat1b& cost = cost_[static_cast<std::size_t>(place.bin)];
    const int left = static_cast<int>(std::lround(centre.x() + growth * place.at.x())) - reach;
    const int top = static_cast<int>(std::lround(centre.y() + growth * place.at.y())) - reach;
    const int first = std::max(0, -left), last = std::min(side, cost.cols - left);
    for (int v = 0; v < side; ++v) {
      unsigned short* const sums = sums_.data() + v * side;
      if (top + v < 0 || top + v >= cost.rows) {
        for (int u = 0; u < side; ++u) sums[u] = static_cast<unsigned short>(sums[u] + kMostCost);
        continue;
      }
      const unsigned char* const row = cost.ptr(top + v) + left;
      for (int u = 0; u < first; ++u) sums[u] = static_cast<unsigned short>(sums[u] + kMostCost);
      for (int u = first; u < last; ++u) sums[u] = static_cast<unsigned short>(sums[u] + row[u]);
      for (int u = std::max(first, last); u < side; ++u) sums[u] = static_cast<unsigned short>(sums[u] + kMostCost);
    }
  }
}

int PoseSearch::leastShift(int reach, cv::Point& shift) const {
  const int side = 2 * reach + 1;
  const auto least = std::min_element(sums_.begin(), sums_.end());
  const int at = static_cast<int>(least - sums_.begin());
  shift = {at % side - reach, at / side - reach};
  return *least;
}

// So that the next least one is another place.
void PoseSearch::coverShift(int reach, const cv::Point& shift) {
  const int side = 2 * reach + 1;
  for (int y = std::max(-reach, shift.y - kPlace); y <= std::min(reach, shift.y + kPlace); ++y) {
    for (int x = std::max(-reach, shift.x - kPlace); x <= std::min(reach, shift.x + kPlace); ++x) {
      sums_[static_cast<std::size_t>((y + reach) * side + x + reach)] = std::numeric_limits<unsigned short>::max();
    }
  }
}

// Gauss-Newton on the distances; what is far from any edge counts little, ever less. The score of where it ends.
double PoseSearch::refine(Outline& outline, double range) {
  Eigen::MatrixXd information(6, 6);
  Eigen::VectorXd mean(6), step(6);
  const Outline expected = outline;
  const double scale = fine_.scale();
  for (int k = 0; k < kIterations; ++k) {
    outline.forgetVisibility();
    outline.look(occluders_, kPieceStep);
    outline.sites(1.0, kSites, sites_);
    const double width = kWide * std::pow(kNarrow / kWide, static_cast<double>(k) / (kIterations - 1));
    outline.known(expected, range * scale, information, mean);
    geometry::Matrix6d normal = information * scale * scale;
    geometry::Vector6d right = normal * mean;
    for (const features::Site& site : sites_) {
      double slope = 0.0;
      const double d = fine_.distance(fine_.toField(site.point), site.normal, slope);
      const double t = 1.0 + d * d / (width * width);
      const Eigen::Map<const geometry::Vector6d> jacobian(site.jacobian.data());
      const geometry::Vector6d row = slope * scale * jacobian;
      normal.noalias() += row * row.transpose() / (t * t);
      right -= row * (d / (t * t));
    }
    step = normal.ldlt().solve(right);
    if (!step.allFinite()) return 0.0;
    outline.move(step);
    if (!outline.isSound()) return 0.0;
  }
  return score(outline);
}

double PoseSearch::score(const Outline& outline) {
  Outline seen = outline;
  seen.forgetVisibility();
  seen.look(occluders_, kPieceStep);
  seen.sites(1.0, kSites, sites_);
  if (sites_.empty()) return 0.0;
  double sum = 0.0;
  for (const features::Site& site : sites_) {
    double slope = 0.0;
    sum += std::max(0.0, 1.0 - fine_.distance(fine_.toField(site.point), site.normal, slope) / kAgrees);
  }
  return sum / static_cast<double>(sites_.size());
}

}  // namespace laparoscope_servo::model
