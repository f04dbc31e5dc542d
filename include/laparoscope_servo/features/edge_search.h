// The edge stage: an oriented mask along the normal of a site, and the places where it answers (Marchand and Chaumette
// 2004, II.B.1).
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/edge_profile.h"

namespace laparoscope_servo::features {

// What an edge looks like. Grey levels.
struct EdgeLooks {
  float contrast = 0.0f;  // the mask's answer: positive where the normal points to what is brighter
  float behind = 0.0f;    // level on the side that the normal points away from
  float ahead = 0.0f;     // on the other
};

struct EdgeCandidate {
  float offset = 0.0f;  // px along the normal, from the site; sub-pixel
  EdgeLooks looks;
};

struct EdgeCandidates {
  static constexpr int kMost = 6;  // the strongest
  std::array<EdgeCandidate, kMost> at;
  int count = 0;
  bool inside = false;  // the image has pixels at the site, as far as the mask reads
};

// How alike two edges are: 0 (not the same edge) to 1. The sign of the contrast is the same, the smaller contrast is at
// least `least` of the larger one, and one side at least has the level that it had, within what light may change.
float similarity(const EdgeLooks& a, const EdgeLooks& b, float least);
// Not told apart: contrast and both sides, within what light changes between neighbouring images.
bool looksAlike(const EdgeLooks& a, const EdgeLooks& b);

class EdgeSearch {
 public:
  // `image`: CV_8UC1 or CV_8UC3, of which the luma is read. Edges weaker than `min_contrast` are not found.
  void find(const cv::Mat& image, const Site& site, const EdgeWindow& window, double min_contrast,
            EdgeCandidates& result);

 private:
  static void add(const EdgeCandidate& candidate, EdgeCandidates& result);

  EdgeProfile profile_;
};

}  // namespace laparoscope_servo::features
