// How long a region that was lost takes to be tracked again: a film up to one of its images, black images, and then
// that image turned, zoomed, dimmed, veiled or half covered. And what an image costs while it is searched for.
#include <boost/program_options.hpp>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "bench/support/arguments.h"
#include "bench/support/scenes.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "ros/common/json_writer.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s
constexpr int kMost = 25;         // images: a second

std::vector<Change> changes() {
  std::vector<Change> all;
  for (const int turn : {0, 15, 30, 45, 60, 75, 90}) all.push_back({"turn " + std::to_string(turn), 1.0 * turn});
  for (const double scale : {0.6, 0.75, 1.3, 1.6}) {
    std::ostringstream name;
    name << "scale " << scale;
    all.push_back({name.str(), 0.0, scale});
    name << ", turn 60";
    all.push_back({name.str(), 60.0, scale});
  }
  all.push_back({"gain 0.5", 0.0, 1.0, 0.5});
  all.push_back({"veil 40 %", 0.0, 1.0, 1.0, 0.4});
  all.push_back({"half covered", 0.0, 1.0, 1.0, 0.0, true});
  return all;
}

struct Tally {
  int trials = 0, back = 0, lies = 0;
  std::vector<double> images;  // until it was back
};

void add(const Tally& from, Tally& to) {
  to.trials += from.trials;
  to.back += from.back;
  to.lies += from.lies;
  to.images.insert(to.images.end(), from.images.begin(), from.images.end());
}

cv::Mat enlarged(const cv::Mat& image, double factor) {
  cv::Mat result;
  cv::resize(image, result, cv::Size(), factor, factor, cv::INTER_CUBIC);
  return result;
}

// The region's film, and each of its images, enlarged.
Scene enlarged(const Scene& scene, double factor) {
  Scene result = scene;
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topLeftCorner<2, 2>() *= factor;
  m.topRightCorner<2, 1>().setConstant(0.5 * (factor - 1.0));
  result.reference = enlarged(scene.reference, factor);
  for (cv::Mat& image : result.images) image = enlarged(image, factor);
  for (cv::Mat& image : result.before) image = enlarged(image, factor);
  for (Eigen::Matrix3d& g : result.g) g = m * g * m.inverse();
  result.roi = {factor * scene.roi.x, factor * scene.roi.y, factor * scene.roi.width, factor * scene.roi.height};
  return result;
}

Tally trial(const Scene& scene, std::size_t which, const Change& change, double absence, std::vector<double>& searching,
            std::vector<std::string>& reasons) {
  std::mt19937 grains(1);  // no two images are the same: a feed that repeats itself is not tracked
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  tracker.select(scene.reference, 0.0, scene.roi);
  double now = 0.0;
  for (const cv::Mat& image : scene.before) tracker.track(image, now += kPeriod);
  const cv::Mat black = cv::Mat::zeros(scene.reference.size(), scene.reference.type());
  const Change nothing;
  Tally tally;
  tally.trials = 1;
  const auto step = [&](const cv::Mat& image) -> const tracking::TrackResult& {
    const double start = threadSeconds();
    const tracking::TrackResult& result = tracker.track(image, now += kPeriod);
    if (result.state != tracking::State::kTracking) searching.push_back(threadSeconds() - start);
    return result;
  };
  for (int k = 0; k < 12; ++k) {
    Eigen::Matrix3d anywhere = Eigen::Matrix3d::Identity();
    step(changed(black, nothing, scene.roi, anywhere, grains, grains));
  }
  now += absence;
  std::string reason;
  for (int k = 1; k <= kMost; ++k) {
    Eigen::Matrix3d g = scene.g[which];
    std::mt19937 same(1);  // it stays where it is
    const cv::Mat image = changed(scene.images[which], change, scene.roi, g, same, grains);
    const tracking::TrackResult& r = step(image);
    if (r.state != tracking::State::kTracking) {
      reason = r.reason;
      continue;
    }
    if (cornerError(r.g, g, scene.roi) < kLost) {
      tally.back = 1;
      tally.images.push_back(k);
      return tally;
    }
    tally.lies = 1;
  }
  reasons.push_back(reason);
  return tally;
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> films;
  std::string file;
  int count = 2;
  double seconds = 20.0, absence = 0.0, factor = 1.0;
  bool why = false;
  po::options_description options(
      "Time until a lost region is tracked again. bench_returns [options] FILM:x,y,w,h ...");
  options.add_options()("help", "this text")                                                                        //
      ("film", po::value(&films), "FILM:x,y,w,h or FILM@N:x,y,w,h, any number")                                     //
      ("images", po::value(&count)->default_value(2), "of each film")                                               //
      ("seconds", po::value(&seconds)->default_value(20.0), "of each film, from which they come")                   //
      ("absence", po::value(&absence)->default_value(0.0), "s without images, beside half a second of black ones")  //
      ("enlarge", po::value(&factor)->default_value(1.0), "every image by this factor")                             //
      ("why", po::bool_switch(&why), "print the last reason of what did not come back")                             //
      ("json", po::value(&file), "write everything there");
  const auto complete = [&] { return !films.empty() && count >= 1; };
  if (const auto status = parse(argc, argv, options, "film", -1, complete)) return *status;
  cv::setNumThreads(1);
  std::map<std::string, Tally> by_change, by_film;
  std::vector<double> searching;
  std::vector<std::string> reasons;
  for (const std::string& film : films) {
    const Scene scene = enlarged(trackedScene(film, count, seconds), factor);
    for (const Change& change : changes()) {
      for (std::size_t k = 0; k < scene.images.size(); ++k) {
        const Tally tally = trial(scene, k, change, absence, searching, reasons);
        add(tally, by_change[change.name]);
        add(tally, by_film[scene.name]);
        if (why && tally.back == 0) std::cout << scene.name << ", " << change.name << ": " << reasons.back() << '\n';
      }
    }
  }
  std::ofstream stream = create(file);
  JsonWriter json(stream);
  json.beginObject();
  const auto write = [&](const std::string& title, const std::map<std::string, Tally>& table) {
    json.beginObject(title);
    for (const auto& [name, t] : table) {
      std::cout << std::left << std::setw(56) << name << std::right << " back within a second " << std::setw(3)
                << t.back << " of " << std::setw(3) << t.trials << ", images: median " << quantile(t.images, 0.5)
                << ", at most " << quantile(t.images, 1.0) << ", wrong " << t.lies << std::endl;
      json.beginObject(name);
      json.value("trials", t.trials);
      json.value("back", t.back);
      json.value("wrong", t.lies);
      json.values("images", t.images);
      json.end();
    }
    json.end();
  };
  write("change", by_change);
  write("film", by_film);
  for (double& s : searching) s *= 1e3;
  std::cout << "searching, ms of one core an image: median " << quantile(searching, 0.5) << ", p99 "
            << quantile(searching, 0.99) << ", at most " << quantile(searching, 1.0) << std::endl;
  json.value("searching_median", quantile(searching, 0.5));
  json.value("searching_p99", quantile(searching, 0.99));
  json.end();
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_returns", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
