// How well the silhouettes of instruments can be predicted from those of earlier images, on films: of what an image's
// own silhouette covers, the share that is missed by the one of so many images before, as it was and as predicted, and
// what the prediction covers besides, as a share of the image.
//
//   bench_masks FOLDER FILM...
#include <algorithm>
#include <cstdio>
#include <deque>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/model/instruments.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/external_masks.h"
#include "support/cpu_clock.h"

namespace {

using laparoscope_servo::bench::cpuTime;
using laparoscope_servo::model::InstrumentTracker;
using laparoscope_servo::robust::nearestRank;
using laparoscope_servo::tracking::ExternalMask;
using laparoscope_servo::tracking::ExternalMasks;

constexpr int kMostLate = 3;  // images

struct Shares {
  std::vector<double> missed_before, missed, besides, time;
};

std::string text(std::vector<double>& values, double scale) {
  if (values.empty()) return "-";
  char line[64];
  std::snprintf(line, sizeof line, "%.2f %.2f %.2f", scale * nearestRank(values, 0.5),
                scale * nearestRank(values, 0.95), scale * nearestRank(values, 1.0));
  return line;
}

void compare(const cv::Mat& truth, const cv::Mat& before, ExternalMasks& masks, double stamp, Shares& shares) {
  const double all = std::max(1, cv::countNonZero(truth));
  const double begin = cpuTime();
  const ExternalMask predicted = masks.at(stamp, truth.size());
  shares.time.push_back(cpuTime() - begin);
  shares.missed_before.push_back(cv::countNonZero(truth & ~before) / all);
  shares.missed.push_back(cv::countNonZero(truth & ~predicted.mask) / all);
  shares.besides.push_back(cv::countNonZero(predicted.mask & ~truth) / static_cast<double>(truth.total()));
}

bool film(const std::string& path, const std::string& name) {
  cv::VideoCapture video(path);
  const double rate = std::max(1.0, video.get(cv::CAP_PROP_FPS));
  InstrumentTracker tracker;
  std::deque<cv::Mat> silhouettes;
  std::vector<ExternalMasks> late(kMostLate, ExternalMasks(10.0));
  std::vector<Shares> shares(kMostLate);
  int images = 0;
  for (cv::Mat image; video.read(image); ++images) {
    const cv::Mat mask = tracker.track(image, images / rate).mask.clone();
    for (int k = 1; k <= kMostLate && k <= static_cast<int>(silhouettes.size()); ++k) {
      const cv::Mat& before = silhouettes[silhouettes.size() - static_cast<std::size_t>(k)];
      ExternalMasks& masks = late[static_cast<std::size_t>(k - 1)];
      masks.add(before, (images - k) / rate);
      if (cv::countNonZero(mask) == 0) continue;
      compare(mask, before, masks, images / rate, shares[static_cast<std::size_t>(k - 1)]);
    }
    silhouettes.push_back(mask);
    if (silhouettes.size() > kMostLate) silhouettes.pop_front();
  }
  if (images == 0) std::fprintf(stderr, "%s: no images\n", path.c_str());
  for (int k = 0; k < kMostLate; ++k) {
    Shares& s = shares[static_cast<std::size_t>(k)];
    std::printf("%-34s %d late, %4zu images: missed as it was %s, predicted %s; besides %s; %s ms\n", name.c_str(),
                k + 1, s.missed.size(), text(s.missed_before, 100.0).c_str(), text(s.missed, 100.0).c_str(),
                text(s.besides, 100.0).c_str(), text(s.time, 1e3).c_str());
  }
  return images > 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_masks FOLDER FILM...\n");
    return 2;
  }
  cv::setNumThreads(1);
  std::printf("%% of the silhouette, %% of the image, ms: median, 95 %%, worst\n");
  bool all = true;
  for (int k = 2; k < argc; ++k) all = film(std::string(argv[1]) + '/' + argv[k], argv[k]) && all;
  return all ? 0 : 1;
}
