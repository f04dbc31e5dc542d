// Which parts of the image follow the dominant motion, by what is left of motion in each cell of ESM's sums.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "motion/motion_aligner.h"

namespace laparoscope_servo::motion {

class MotionSupport {
 public:
  // Values of the map.
  enum : unsigned char { kForeign = 0, kSilent = 128, kFollows = 255 };

  // Of the alignment that the aligner has just made. Does not allocate for a further image of the same size.
  void judge(MotionAligner& aligner, const MotionImage& current, const Alignment& at);
  // Nothing is known of an image.
  void clear();

  // Of the gradient energy of all cells that have a say, what follows; 0 where none has.
  double share() const { return share_; }
  // Of all cells, those that have a say.
  double textured() const { return textured_; }
  // Grey levels, robust standard deviation of the residuals in the cells that follow, on the level that was judged; 0
  // where none follows.
  double sigma() const { return sigma_; }
  int level() const { return level_; }

  // A cell each, of cellSize() px of the reference image: kFollows; kForeign, where something else moves or covers;
  // kSilent, without texture, masked or out of view. Empty before the first judgement.
  const cv::Mat1b& map() const { return map_; }
  cv::Size cellSize() const { return cell_; }

 private:
  void measureScale(const tracking::EsmLevel& level, double gain);

  cv::Mat1b map_;
  cv::Size cell_;
  int level_ = 0;
  double share_ = 0.0, textured_ = 0.0, sigma_ = 0.0;
  double level_scale_ = 0.0;
  double noise_ = 0.0;        // variance of a gradient in each direction, for residuals of variance 1
  std::vector<double> kept_;  // gradient energy of each cell, with Tukey's weights
  std::vector<float> magnitudes_;
};

}  // namespace laparoscope_servo::motion
