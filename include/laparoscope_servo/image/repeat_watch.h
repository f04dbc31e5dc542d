// Notices pictures that have been seen before: a grabber that goes on with its last picture, or with the few that its
// buffers still hold. The noise of a sensor makes every true picture another one, to the last digit.
//
// A picture is cut into tiles, and of each tile two fingerprints are kept, of its even and of its odd rows: a picture
// of which one field stands still stands still. Pixels between the rows that are looked at are not compared: every
// block of 4 x 4 px, the smallest that a video codec changes, has at least one such row.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

// How many pictures in a row, up to this one, were seen before. 0: this one is new.
struct Repeats {
  int whole = 0;  // in each of its pixels
  // In the region alone, or in a band across the whole picture, kBand tiles wide, that the region has a part in: a
  // picture of which one half stands still. At least `whole`.
  int region = 0;
  // In a part of the region alone: of all the texture in the region, kPart repeated as often, each tile for itself.
  // Tiles that have never been seen to change do not count: what is burnt into the picture repeats for ever.
  int part = 0;
};

class RepeatWatch {
 public:
  // Pictures that are remembered: more than the buffers of a driver (V4L2's usual number is 4), so that old pictures
  // which come in turn are found, too.
  static constexpr int kMemory = 8;
  // And of these, the whole alone, in the order in which they came: a grabber that goes over the same seconds again and
  // again. 10 s at 25 Hz; as many of 640x480 in colour are 236 MB, more than one holds. A film that runs backwards
  // shows old pictures in another order.
  static constexpr int kLoop = 256;
  static constexpr int kTile = 16;       // px: a macroblock
  static constexpr int kBand = 4;        // tiles: what a codec skips does not reach across the picture in all of them
  static constexpr double kPart = 0.25;  // of the region's texture: less does not drag the tracker along
  static constexpr int kMargin = 8;      // tiles about the region that are counted, at least
  static constexpr int kLive = 4;        // pictures in a row that were new: no clock, whose digits change by the second

  // The next picture, of 8 bit, and the region of interest in it [px]; an empty one: none, as if it were new.
  Repeats see(const cv::Mat& image, const cv::Rect& region);
  void clear();

 private:
  struct Print {
    std::array<std::uint64_t, 2> field{};  // of even, of odd rows
  };
  using Prints = std::vector<Print>;  // row by row of tiles

  void take(const cv::Mat& image, Prints& prints) const;
  // Of the picture `back` before the newest, 0 to known_.
  const Prints& printsOf(int back) const;
  int loopRepeats();
  bool repeats(const cv::Rect& tiles) const;
  bool hasBeenLive(const cv::Rect& tiles) const;
  bool bandRepeats(const cv::Rect& tiles) const;
  cv::Rect nearby(const cv::Rect& tiles) const;
  void countTiles(const cv::Rect& tiles);
  void forgetOutside(const cv::Rect& tiles);
  int partRepeats(const cv::Mat& image, const cv::Rect& tiles) const;

  cv::Size size_;
  int type_ = -1;
  cv::Size tiles_;
  std::array<Prints, kMemory + 1> ring_;  // of this picture and those before
  int newest_ = 0;
  std::deque<Print> wholes_;  // of whole pictures, up to kLoop of them
  std::size_t loop_ = 0;      // pictures, after which they come again; 0: they do not
  int in_loop_ = 0;           // pictures in a row
  int known_ = 0;             // pictures before the newest
  Repeats counts_;
  // Of a tile, whatever the others do.
  struct History {
    std::array<int, 2> repeats{};  // in a row, of each field
    int fresh = 0;                 // pictures in a row that were new here; kLive: there have been as many
  };
  std::vector<History> history_;  // of each tile, counted where it is watched
  cv::Rect watched_;              // tiles
};

}  // namespace laparoscope_servo::image
