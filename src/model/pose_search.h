// Where a model may be when its pose is known badly: turns, sizes and shifts about the pose that is expected are scored
// on a reduced image, and the best of them are refined there.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "model/edge_field.h"
#include "model/outline.h"

namespace laparoscope_servo::model {

struct PoseRange {
  double rotation = 0.0;  // rad about each axis of the camera
  double shift = 0.0;     // of the model's radius in the image
};

struct PoseCandidate {
  Eigen::Isometry3d camera_T_object = Eigen::Isometry3d::Identity();
  double score = 0.0;  // 0 (no edge near any site) to 1 (one at each)
};

class PoseSearch {
 public:
  // `most` candidates, best first, no two of which are the same. `outline`: at the pose that is expected, whose centre
  // has to be in front of the camera. Deterministic.
  std::vector<PoseCandidate> find(const cv::Mat& image, const Outline& outline, const PoseRange& range,
                                  double min_contrast, std::size_t most);

 private:
  struct Place {
    int bin;
    Eigen::Vector2d at;  // px of the coarse field, from the model's centre
  };

  void scoreShifts(const Outline& expected, const PoseRange& range, std::vector<PoseCandidate>& all);
  // The sum of costs at each shift by up to `reach`, row by row.
  void sumShifts(const Eigen::Vector2d& centre, double growth, int reach);
  int leastShift(int reach, cv::Point& shift) const;
  void coverShift(int reach, const cv::Point& shift);
  // Refines them in the fine field and keeps the best, no two of which are the same there. Sorts `all`.
  void refineBest(std::vector<PoseCandidate>& all, const Outline& expected, double rotation, std::size_t most,
                  std::vector<PoseCandidate>& best);
  double refine(Outline& outline, double range);
  double score(const Outline& outline);

  Occluders occluders_;
  EdgeField coarse_, fine_;
  std::array<cv::Mat1b, EdgeField::kBins> cost_;
  std::vector<features::Site> sites_;
  std::vector<Place> places_;
  std::vector<unsigned short> sums_;
};

}  // namespace laparoscope_servo::model
