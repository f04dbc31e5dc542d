// The shift of an image on which most of its blocks agree, from whatever it started: each block votes for the place
// where it is found again.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::motion {

class ShiftVotes {
 public:
  // Searched for, px of the level, either way.
  static constexpr int kReach = 3;

  // Px of the level, around no motion; zero when no block votes. Blocks are compared without their means. `current`: of
  // the level's size. The level's weights say which blocks take part. Does not allocate for a further image of the same
  // size.
  Eigen::Vector2d find(const tracking::EsmLevel& reference, const cv::Mat1f& current);

 private:
  static constexpr int kAlong = 2 * kReach + 1;
  // Of the differences, for each shift down, and along with it for each one to the right; the rest pads a vector.
  static constexpr int kLanes = 8;
  using Sums = double[kAlong][kLanes];
  struct Block {
    Sums sum, squares;
    int pixels[kAlong][kLanes];
  };
  struct Vote {
    Eigen::Vector2d shift;
    double weight;
  };
  void compare(const tracking::EsmLevel& reference, const cv::Mat1f& current, int down);
  void vote(const tracking::EsmLevel& reference);

  int columns_ = 0;
  std::vector<Block> blocks_;
  std::vector<Vote> votes_;
  std::vector<float> row_, inside_;  // of the current image, kReach px longer at either end, where `inside_` is 0
};

}  // namespace laparoscope_servo::motion
