// The instrument tracker on films, without a click: in how many images it tracks an instrument, how many identities it
// took for that, and the processor's time; with instruments/ in the folder also how well silhouettes cover those of the
// stills.
//
//   bench_instruments FOLDER FILM...
#include "laparoscope_servo/model/instruments.h"

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

namespace {

using laparoscope_servo::features::State;
using laparoscope_servo::model::Instrument;
using laparoscope_servo::model::InstrumentsResult;
using laparoscope_servo::model::InstrumentTracker;

double processorTime() {  // ms, of this thread
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

bool film(const std::string& path, const std::string& name) {
  cv::VideoCapture video(path);
  const double rate = std::max(1.0, video.get(cv::CAP_PROP_FPS));
  InstrumentTracker tracker;
  std::map<int, int> tracked;  // images, by identity
  std::vector<double> times;
  int with = 0, images = 0;
  for (cv::Mat image; video.read(image); ++images) {
    const double begin = processorTime();
    const InstrumentsResult& result = tracker.track(image, images / rate);
    times.push_back(processorTime() - begin);
    bool any = false;
    for (const Instrument& i : result.instruments) {
      if (i.state != State::kTracking) continue;
      any = true;
      ++tracked[i.id];
    }
    with += any ? 1 : 0;
  }
  if (times.empty()) {
    std::fprintf(stderr, "%s: no images\n", path.c_str());
    return false;
  }
  std::sort(times.begin(), times.end());
  std::printf("%-36s %5d images, %5d with an instrument; median %.2f ms, 99 %% %.2f ms; images by identity:",
              name.c_str(), images, with, times[times.size() / 2], times[times.size() * 99 / 100]);
  for (const auto& [id, count] : tracked) std::printf(" %d:%d", id, count);
  std::printf("\n");
  return true;
}

void stills(const std::string& folder) {
  constexpr int kRepeats = 8;  // a film that stands still: what is not clear at once has to be confirmed
  double sum = 0.0;
  int count = 0;
  for (int n = 0;; ++n, ++count) {
    const std::string name = folder + "/instruments/" + std::to_string(n);
    const cv::Mat image = cv::imread(name + ".jpg"), parts = cv::imread(name + "_parts.png", cv::IMREAD_GRAYSCALE);
    if (image.empty() || parts.empty()) break;
    InstrumentTracker tracker;
    for (int k = 0; k < kRepeats; ++k) tracker.track(image, k / 25.0);
    const cv::Mat truth = parts > 0, mask = tracker.result().mask;
    const double share =
        cv::countNonZero(mask & truth) / std::max(1.0, static_cast<double>(cv::countNonZero(mask | truth)));
    std::printf("still %d: IoU %.3f, %zu instruments\n", n, share, tracker.result().instruments.size());
    sum += share;
  }
  if (count > 0) std::printf("mean IoU %.3f\n", sum / count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_instruments FOLDER FILM...\n");
    return 2;
  }
  cv::setNumThreads(1);
  bool all = true;
  for (int k = 2; k < argc; ++k) all = film(std::string(argv[1]) + '/' + argv[k], argv[k]) && all;
  stills(argv[1]);
  return all ? 0 : 1;
}
