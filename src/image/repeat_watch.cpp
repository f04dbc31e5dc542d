#include "laparoscope_servo/image/repeat_watch.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace laparoscope_servo::image {

namespace {

// One row of each field in every 8 rows: a quarter of the pixels, and every block of 4 rows that begins at a multiple
// of 4 has one.
constexpr int kPeriod = 8;
constexpr int kFieldRow[2] = {0, 5};

// Multiplication by an odd number is invertible, and the shift mixes the high bits into the low ones: rows that differ
// have equal fingerprints with a probability of 2^-64.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
  return hash ^ (hash >> 29);
}

std::uint64_t mixedRow(std::uint64_t hash, const unsigned char* row, int bytes) {
  // Four independent sums, so that the processor can overlap the multiplications.
  std::uint64_t lanes[4] = {hash, ~hash, hash + 1, hash + 2};
  int at = 0;
  for (; at + 32 <= bytes; at += 32) {
    std::uint64_t words[4];
    std::memcpy(words, row + at, 32);
    for (int k = 0; k < 4; ++k) lanes[k] = mixed(lanes[k], words[k]);
  }
  for (; at < bytes; at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, row + at, static_cast<std::size_t>(std::min(8, bytes - at)));
    lanes[0] = mixed(lanes[0], word);
  }
  return mixed(lanes[0] + 3 * lanes[1], lanes[2] + 5 * lanes[3]);
}

// The tiles within the region; if it is too small to hold one, those that touch it.
cv::Rect tilesOf(const cv::Rect& region, const cv::Size& tiles) {
  constexpr int kTile = RepeatWatch::kTile;
  const auto up = [](int value) { return (value + kTile - 1) / kTile; };
  const cv::Rect all(cv::Point(0, 0), tiles);
  const cv::Point first(up(region.x), up(region.y));
  const cv::Point end(region.br().x / kTile, region.br().y / kTile);
  if (end.x > first.x && end.y > first.y) return cv::Rect(first, end) & all;
  return cv::Rect(cv::Point(region.x / kTile, region.y / kTile), cv::Point(up(region.br().x), up(region.br().y))) & all;
}

// Amount of texture in a tile: the sum of differences between pixels two apart, along rows and columns.
double textureOf(const cv::Mat& image, const cv::Rect& tile) {
  constexpr int kApart = 2;  // px: differences of nearer pixels are mostly noise
  const int channels = image.channels();
  const int channel = channels / 2;  // the green one
  long sum = 0;
  for (int y = tile.y; y < std::min(tile.br().y, image.rows - kApart); y += kApart) {
    const unsigned char* const row = image.ptr(y) + channel;
    const unsigned char* const below = image.ptr(y + kApart) + channel;
    for (int x = tile.x; x < std::min(tile.br().x, image.cols - kApart); ++x) {
      sum += std::abs(row[(x + kApart) * channels] - row[x * channels]) +
             std::abs(below[x * channels] - row[x * channels]);
    }
  }
  return static_cast<double>(sum);
}

}  // namespace

Repeats RepeatWatch::see(const cv::Mat& image, const cv::Rect& region) {
  if (image.size() != size_ || image.type() != type_) {
    clear();
    size_ = image.size();
    type_ = image.type();
    tiles_ = cv::Size((size_.width + kTile - 1) / kTile, (size_.height + kTile - 1) / kTile);
    history_.assign(static_cast<std::size_t>(tiles_.area()), History());
  }
  newest_ = (newest_ + 1) % static_cast<int>(ring_.size());
  take(image, ring_[static_cast<std::size_t>(newest_)]);
  const cv::Rect in_image = region & cv::Rect(cv::Point(0, 0), size_);
  counts_.whole = repeats(cv::Rect(cv::Point(0, 0), tiles_)) ? counts_.whole + 1 : 0;
  const int in_loop = loopRepeats();
  if (in_loop > 1) counts_.whole = std::max(counts_.whole, in_loop);
  const cv::Rect tiles = tilesOf(in_image, tiles_);
  counts_.region = !in_image.empty() && (repeats(tiles) || bandRepeats(tiles)) ? counts_.region + 1 : 0;
  counts_.region = std::max(counts_.region, counts_.whole);
  countTiles(nearby(tiles));
  counts_.part = in_image.empty() ? counts_.whole : std::max(counts_.whole, partRepeats(image, tiles));
  known_ = std::min(known_ + 1, kMemory);
  return counts_;
}

void RepeatWatch::clear() {
  known_ = 0;
  wholes_.clear();
  loop_ = 0;
  counts_ = Repeats();
  std::fill(history_.begin(), history_.end(), History());
  watched_ = cv::Rect();
}

void RepeatWatch::take(const cv::Mat& image, Prints& prints) const {
  prints.assign(static_cast<std::size_t>(tiles_.area()), Print());
  const int pixel = static_cast<int>(image.elemSize());
  for (int block = 0; block < image.rows; block += kPeriod) {
    Print* const row_of_tiles = &prints[static_cast<std::size_t>(block / kTile) * tiles_.width];
    for (int field = 0; field < 2; ++field) {
      // If the image ends within the block, the last row of that field is used.
      int row = block + kFieldRow[field];
      while (row >= image.rows) row -= 2;
      if (row < block) continue;
      const unsigned char* const pixels = image.ptr(row);
      for (int tile = 0; tile < tiles_.width; ++tile) {
        std::uint64_t& hash = row_of_tiles[tile].field[static_cast<std::size_t>(field)];
        const int left = tile * kTile;
        hash = mixedRow(hash, pixels + left * pixel, std::min(kTile, image.cols - left) * pixel);
      }
    }
  }
}

int RepeatWatch::loopRepeats() {
  Print whole;
  for (const Print& tile : printsOf(0)) {
    for (std::size_t field = 0; field < 2; ++field) {
      whole.field[field] = mixed(whole.field[field], tile.field[field]);
    }
  }
  wholes_.push_front(whole);
  if (wholes_.size() > kLoop + 1) wholes_.pop_back();
  const auto same = [&](std::size_t back) { return back < wholes_.size() && wholes_[back].field == whole.field; };
  if (loop_ > 0 && same(loop_)) return ++in_loop_;
  loop_ = 1;
  while (loop_ < wholes_.size() && !same(loop_)) ++loop_;
  if (loop_ == wholes_.size()) loop_ = 0;
  return in_loop_ = loop_ > 0 ? 1 : 0;
}

const RepeatWatch::Prints& RepeatWatch::printsOf(int back) const {
  const int places = static_cast<int>(ring_.size());
  return ring_[static_cast<std::size_t>((newest_ - back + places) % places)];
}

// Black bars beside a picture always repeat.
bool RepeatWatch::hasBeenLive(const cv::Rect& tiles) const {
  for (int y = tiles.y; y < tiles.br().y; ++y) {
    for (int x = tiles.x; x < tiles.br().x; ++x) {
      if (history_[static_cast<std::size_t>(y) * tiles_.width + x].fresh >= kLive) return true;
    }
  }
  return false;
}

// Rows or columns of tiles across the whole picture, all of them within the region's extent.
bool RepeatWatch::bandRepeats(const cv::Rect& tiles) const {
  for (int y = tiles.y; y + kBand <= tiles.br().y; ++y) {
    if (hasBeenLive(cv::Rect(tiles.x, y, tiles.width, kBand)) && repeats(cv::Rect(0, y, tiles_.width, kBand))) {
      return true;
    }
  }
  for (int x = tiles.x; x + kBand <= tiles.br().x; ++x) {
    if (hasBeenLive(cv::Rect(x, tiles.y, kBand, tiles.height)) && repeats(cv::Rect(x, 0, kBand, tiles_.height))) {
      return true;
    }
  }
  return false;
}

// Tiles that the region may reach within some pictures, so that not all tiles of large images are counted.
cv::Rect RepeatWatch::nearby(const cv::Rect& tiles) const {
  const cv::Size margin(std::max(kMargin, tiles.width / 2), std::max(kMargin, tiles.height / 2));
  const cv::Rect grown(tiles.x - margin.width, tiles.y - margin.height, tiles.width + 2 * margin.width,
                       tiles.height + 2 * margin.height);
  return grown & cv::Rect(cv::Point(0, 0), tiles_);
}

// A picture that repeats as a whole has no information on which tiles change.
void RepeatWatch::countTiles(const cv::Rect& tiles) {
  if (tiles != watched_) forgetOutside(tiles);
  watched_ = tiles;
  const Prints& now = printsOf(0);
  const auto count = [&](std::size_t tile) {
    History& history = history_[tile];
    for (std::size_t field = 0; field < 2; ++field) {
      bool seen = false;
      for (int back = 1; back <= known_ && !seen; ++back) {
        seen = printsOf(back)[tile].field[field] == now[tile].field[field];
      }
      history.repeats[field] = seen ? history.repeats[field] + 1 : 0;
    }
    if (history.fresh >= kLive || known_ == 0 || counts_.whole > 0) return;
    const bool fresh = history.repeats[0] == 0 && history.repeats[1] == 0;
    history.fresh = fresh ? history.fresh + 1 : 0;
  };
  for (int y = tiles.y; y < tiles.br().y; ++y) {
    for (int x = tiles.x; x < tiles.br().x; ++x) count(static_cast<std::size_t>(y) * tiles_.width + x);
  }
}

void RepeatWatch::forgetOutside(const cv::Rect& tiles) {
  for (int y = watched_.y; y < watched_.br().y; ++y) {
    for (int x = watched_.x; x < watched_.br().x; ++x) {
      if (!tiles.contains(cv::Point(x, y))) history_[static_cast<std::size_t>(y) * tiles_.width + x] = History();
    }
  }
}

int RepeatWatch::partRepeats(const cv::Mat& image, const cv::Rect& tiles) const {
  struct Tile {
    int repeats;
    cv::Rect pixels;
  };
  std::vector<Tile> live;
  bool any = false;
  for (int y = tiles.y; y < tiles.br().y; ++y) {
    for (int x = tiles.x; x < tiles.br().x; ++x) {
      const History& history = history_[static_cast<std::size_t>(y) * tiles_.width + x];
      if (history.fresh < kLive) continue;
      const int repeats = std::max(history.repeats[0], history.repeats[1]);
      live.push_back({repeats, cv::Rect(x * kTile, y * kTile, kTile, kTile)});
      any = any || repeats > 0;
    }
  }
  if (!any) return 0;  // the usual case: no tile repeats, so texture is not computed
  std::sort(live.begin(), live.end(), [](const Tile& a, const Tile& b) { return a.repeats > b.repeats; });
  std::vector<double> up_to;
  double sum = 0.0;
  for (const Tile& tile : live) up_to.push_back(sum += textureOf(image, tile.pixels));
  const auto enough = std::lower_bound(up_to.begin(), up_to.end(), kPart * sum);
  return sum > 0.0 ? live[static_cast<std::size_t>(enough - up_to.begin())].repeats : 0;
}

bool RepeatWatch::repeats(const cv::Rect& tiles) const {
  const Prints& now = printsOf(0);
  for (int back = 1; back <= known_; ++back) {
    const Prints& then = printsOf(back);
    bool same[2] = {true, size_.height > 1};
    for (int y = tiles.y; y < tiles.br().y && (same[0] || same[1]); ++y) {
      for (int x = tiles.x; x < tiles.br().x; ++x) {
        const std::size_t tile = static_cast<std::size_t>(y) * tiles_.width + x;
        for (int field = 0; field < 2; ++field) {
          same[field] = same[field] && now[tile].field[field] == then[tile].field[field];
        }
        if (!same[0] && !same[1]) break;
      }
    }
    if (same[0] || same[1]) return true;
  }
  return false;
}

}  // namespace laparoscope_servo::image
