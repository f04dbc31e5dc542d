// What the trackers of models and of instruments hold, in images of 1920x1080, and whether it grows: the resident
// memory of the process, MB, before a tracker is made, after its first images, and after all of them.
#include <malloc.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "bench/support/arguments.h"
#include "laparoscope_servo/model/instruments.h"
#include "laparoscope_servo/model/model_tracker.h"
#include "test/support/synthetic_instrument.h"
#include "test/support/synthetic_model.h"

namespace laparoscope_servo::bench {

namespace {

constexpr int kPictures = 8;  // shown there and back
constexpr int kSettled = 50;  // images
constexpr double kPeriod = 0.04;

// Without what was freed and not given back yet.
double residentMegabytes() {
  malloc_trim(0);
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

// `track`: takes the image and its stamp, and tells whether the state is TRACKING.
void run(const char* name, const std::vector<cv::Mat>& pictures, int images, double before,
         const std::function<bool(const cv::Mat&, double)>& track) {
  int tracked = 0;
  double settled = 0.0;
  for (int k = 0; k < images; ++k) {
    const int step = k % (2 * kPictures - 2);
    const int shown = step < kPictures ? step : 2 * kPictures - 2 - step;
    tracked += track(pictures[static_cast<std::size_t>(shown)], kPeriod * k) ? 1 : 0;
    if (k + 1 == kSettled) settled = residentMegabytes();
  }
  std::cout << std::left << std::setw(12) << name << std::right << std::fixed << std::setprecision(1) << std::setw(9)
            << settled - before << std::setw(9) << residentMegabytes() - settled << std::setw(10) << tracked
            << std::endl;
}

std::vector<cv::Mat> shafts() {
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < kPictures; ++k) {
    test_support::ShaftScene scene;
    scene.size = {1920, 1080};
    scene.entry = {1980.0, 740.0};
    scene.tip = {750.0 + 6.0 * k, 580.0 + 3.0 * k};
    scene.tip_width = 180.0;
    scene.entry_width = 270.0;
    scene.seed = k + 1;
    pictures.push_back(test_support::drawShaft(scene).image);
  }
  return pictures;
}

int measure(int argc, char** argv) {
  int images = 0;
  boost::program_options::options_description options(
      "bench_memory: what trackers hold at 1920x1080, and whether it grows");
  options.add_options()("help", "this text")("images", boost::program_options::value(&images)->default_value(10000),
                                             "shown to each tracker");
  if (const auto status = parse(argc, argv, options, "images", 1, [&] { return images > kSettled; })) return *status;
  std::cout << "tracker     first MB growth MB   tracked of " << images << '\n';
  {
    const auto cube = test::modelOf(test::kCubeAndTube);
    test::ModelScene scene;
    scene.size = {1920, 1080};
    scene.camera = {1800.0, 1800.0, 959.5, 539.5};
    const test::ModelRenderer renderer(*cube, scene);
    std::vector<cv::Mat> pictures;
    const auto pose = [&cube](int k) { return test::viewOf(*cube, 0.55, 0.6 + 0.005 * k); };
    for (int k = 0; k < kPictures; ++k) pictures.push_back(renderer.draw(pose(k), static_cast<unsigned>(k + 1)));
    const double before = residentMegabytes();
    model::ModelTracker tracker(cube, scene.camera);
    tracker.select(pictures[0], 0.0, pose(0));
    run("model", pictures, images, before, [&tracker](const cv::Mat& image, double stamp) {
      return tracker.track(image, stamp).state == features::State::kTracking;
    });
  }
  {
    const std::vector<cv::Mat> pictures = shafts();
    const double before = residentMegabytes();
    model::InstrumentTracker tracker;
    run("instrument", pictures, images, before, [&tracker](const cv::Mat& image, double stamp) {
      const auto& found = tracker.track(image, stamp).instruments;
      return found.size() == 1 && found[0].state == features::State::kTracking;
    });
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_memory", [&] { return laparoscope_servo::bench::measure(argc, argv); });
}
