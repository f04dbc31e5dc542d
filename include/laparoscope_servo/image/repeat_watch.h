// Detects repeated pictures: a grabber that repeats its last picture, or the few in its buffers. Sensor noise makes
// every new picture differ from all others. (servo::RepeatWatch does this for task errors.)
//
// A picture is divided into tiles, each with two fingerprints, of its even and of its odd rows, so that a picture
// counts as repeated also if only one field repeats. Only some of the rows are used, but every block of 4 x 4 px, the
// smallest that a video codec changes, has at least one such row.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

// Number of pictures in a row, up to this one, that repeat an earlier one. 0: this one is new.
struct Repeats {
  int whole = 0;  // the whole picture
  // In the region, or in a band across the whole picture, kBand tiles wide, that overlaps the region (a picture of
  // which one half is frozen). At least `whole`.
  int region = 0;
  // In a part of the region: tiles that hold the share kPart of the region's texture repeated at least this often.
  // Tiles that have never changed are not used, since overlays in the picture always repeat.
  int part = 0;
};

class RepeatWatch {
 public:
  // Number of pictures kept: more than the buffers of a driver (usually 4 with V4L2), so that old pictures that repeat
  // in turn are found too.
  static constexpr int kMemory = 8;
  // And of these, the whole alone, in the order in which they came: a grabber that goes over the same seconds again and
  // again. 10 s at 25 Hz; as many of 640x480 in colour are 236 MB, more than one holds. A film that runs backwards
  // shows old pictures in another order.
  static constexpr int kLoop = 256;
  static constexpr int kTile = 16;       // px: a macroblock
  static constexpr int kBand = 4;        // tiles: blocks that a codec skips do not fill a whole band this wide
  static constexpr double kPart = 0.25;  // of the region's texture: a smaller frozen part does not pull the tracker
  static constexpr int kMargin = 8;      // tiles around the region for which repeats are counted, at least
  // new pictures in a row after which a tile counts as live; a clock's digits change only every second
  static constexpr int kLive = 4;

  // Takes the next picture, of 8 bit, and the region of interest in it [px]. With an empty region only whole pictures
  // are compared.
  Repeats see(const cv::Mat& image, const cv::Rect& region);
  void clear();

 private:
  struct Print {
    std::array<std::uint64_t, 2> field{};  // fingerprints of even and of odd rows
  };
  using Prints = std::vector<Print>;  // ordered by row of tiles

  void take(const cv::Mat& image, Prints& prints) const;
  // Fingerprints of the picture `back` before the newest, 0 to known_.
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
  std::array<Prints, kMemory + 1> ring_;  // fingerprints of this picture and the last ones
  int newest_ = 0;
  std::deque<Print> wholes_;  // of whole pictures, up to kLoop of them
  std::size_t loop_ = 0;      // pictures, after which they come again; 0: they do not
  int in_loop_ = 0;           // pictures in a row
  int known_ = 0;             // pictures before the newest
  Repeats counts_;
  // History of one tile.
  struct History {
    std::array<int, 2> repeats{};  // repeats in a row, of each field
    int fresh = 0;                 // new pictures in a row for this tile; stays at kLive once reached
  };
  std::vector<History> history_;  // history of each tile, updated within watched_
  cv::Rect watched_;              // tiles
};

}  // namespace laparoscope_servo::image
