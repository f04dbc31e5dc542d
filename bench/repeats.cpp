// Where the line lies between a feed that stands still and one that is only compressed: how often pictures repeat, in
// whole and within regions, how long, how often FrozenFeed says so, and what it costs to find out. Pictures come from
// standard input, raw:
//
//   ffmpeg -i FILM -f rawvideo -pix_fmt bgr24 - | bench_repeats --size 1280x720 --roi 580,180,220,340
#include <algorithm>
#include <boost/program_options.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/support/arguments.h"
#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/frozen_feed.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s, between images

struct Row {
  std::string name;
  cv::Rect region;
  double step = 0.0;  // px an image, that the region is said to move by
  image::RepeatWatch watch;
  tracking::FrozenFeed feed{tracking::InputConfig()};
  long whole = 0, within = 0, part = 0, said = 0;
  int longest_whole = 0, longest_within = 0, longest_part = 0;
  long first_said = -1;
  double time = 0.0;  // s
};

void see(Row& row, const cv::Mat& picture, long frame) {
  const auto begin = std::chrono::steady_clock::now();
  const image::Repeats repeats = row.watch.see(picture, row.region);
  row.feed.see(repeats, kPeriod * static_cast<double>(frame), {row.step, row.step * repeats.part, 0.0});
  row.time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  row.longest_part = std::max(row.longest_part, repeats.part);
  row.part += repeats.part > 0 ? 1 : 0;
  row.whole += repeats.whole > 0 ? 1 : 0;
  row.within += repeats.region > 0 ? 1 : 0;
  row.longest_whole = std::max(row.longest_whole, repeats.whole);
  row.longest_within = std::max(row.longest_within, repeats.region);
  if (row.feed.reason().empty()) return;
  ++row.said;
  if (row.first_said < 0) row.first_said = frame;
}

int measure(const cv::Size& size, const std::vector<std::string>& rois) {
  std::vector<Row> rows;
  for (const std::string& roi : rois) {
    const geometry::Rectangle r = parseRoi(roi);
    for (const double step : {0.0, 1.0}) {
      Row row;
      row.name = roi + (step > 0.0 ? " moving" : " still");
      row.region =
          cv::Rect(static_cast<int>(r.x), static_cast<int>(r.y), static_cast<int>(r.width), static_cast<int>(r.height));
      row.step = step;
      rows.push_back(row);
    }
  }
  cv::Mat picture(size, CV_8UC3);
  long frames = 0;
  for (; std::fread(picture.data, picture.total() * 3, 1, stdin) == 1; ++frames) {
    for (Row& row : rows) see(row, picture, frames);
  }
  std::cout << "region,images,whole repeats,longest,repeats within,longest,in part,longest,images said,first said,ms "
               "an image\n";
  for (const Row& row : rows) {
    std::cout << '"' << row.name << "\"," << frames << ',' << row.whole << ',' << row.longest_whole << ',' << row.within
              << ',' << row.longest_within << ',' << row.part << ',' << row.longest_part << ',' << row.said << ','
              << row.first_said << ',' << 1e3 * row.time / static_cast<double>(std::max(1L, frames)) << '\n';
  }
  return EXIT_SUCCESS;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  namespace options = boost::program_options;
  using namespace laparoscope_servo::bench;
  std::string size;
  std::vector<std::string> rois;
  options::options_description description("Options");
  description.add_options()("help", "print this and end")(
      "size", options::value(&size), "WIDTHxHEIGHT of the pictures")("roi", options::value(&rois)->composing(),
                                                                     "x,y,w,h, once or several times");
  if (const auto status = parse(argc, argv, description, "", 0, [&] { return !size.empty() && !rois.empty(); })) {
    return *status;
  }
  return run("bench_repeats", [&] {
    int width = 0;
    int height = 0;
    if (std::sscanf(size.c_str(), "%dx%d", &width, &height) != 2 || width <= 0 || height <= 0) {
      throw std::invalid_argument("size '" + size + "', expected e.g. 1280x720");
    }
    return measure(cv::Size(width, height), rois);
  });
}
