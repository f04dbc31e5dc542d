// Finds the cuts of an edited film: between two images that go on smoothly before and behind, the place changes.
//
// A fast move of camera or instrument, a flash, smoke, a glitch are none: either one image still shows much of what the
// one before did, or the images around do not go on smoothly, or the old place is seen again within kAfter. Nor is a
// cut to the same place, or one into a fast move. Dissolves are not found. Dark images are passed over: between two
// scenes they belong to none.
#pragma once

#include <cstddef>
#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/image/sketch.h"

namespace laparoscope_servo::image {

struct Cut {
  std::size_t last = 0;   // image of the scene before, counted from 0
  std::size_t first = 0;  // image of the next scene; between them there may be dark ones, or one that is a mixture
};

class CutFinder {
 public:
  static constexpr double kAfter = 0.4;  // s: a flash, or a wipe across the lens, is over

  // `rate`: Hz, of the images; throws std::invalid_argument unless it is more than 0.
  explicit CutFinder(double rate);

  // Takes the next image, CV_8UC1 or CV_8UC3, and returns the cut that is certain by now, if there is one: they come in
  // order.
  std::optional<Cut> see(const cv::Mat& image);
  // An image that cannot be used: it counts, as a dark one does.
  std::optional<Cut> miss();
  // No more images come: those that are left.
  std::vector<Cut> end();

  // No image before this one can be Cut::first of a cut that is still to come.
  std::size_t undecided() const { return undecided_; }

 private:
  struct Entry {
    std::size_t number;
    Sketch sketch;
    double likeness;  // to the one before; 1 for the first
  };

  std::optional<Cut> decideNext();
  std::optional<Cut> decide(std::size_t at) const;
  bool mayBeMixture(std::size_t at) const;
  bool goesOn(std::size_t at, double least) const;
  bool isOther(std::size_t last, std::size_t first) const;

  std::size_t after_;          // images
  std::size_t next_ = 0;       // number of the next image
  std::size_t undecided_ = 0;  // number of the first image of which it is not decided whether a scene begins with it
  std::deque<Entry> seen_;     // without dark ones
};

}  // namespace laparoscope_servo::image
