// Dominant motion, beside OpenCV's optical flow with a robust fit, in one run: on drawn pictures whose motion is known,
// over 250 images, and on films, forward and backward, beside the region tracker.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "bench/support/arguments.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/flow_peers.h"
#include "bench/support/motion_scenes.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/motion/anchored_motion.h"
#include "laparoscope_servo/motion/dominant_motion.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

using features::State;
using motion::DominantMotion;
using motion::Model;

constexpr double kPeriod = 0.04;  // s

const char* nameOf(Model model) {
  const char* const names[] = {"constant", "affine", "quadratic"};
  return names[static_cast<std::size_t>(model)];
}

struct Measured {
  std::vector<double> errors, times;  // px; ms
  int images = 0, kept = 0;

  void add(bool is_kept, double error, double seconds) {
    ++images;
    times.push_back(1e3 * seconds);
    if (!is_kept) return;
    ++kept;
    errors.push_back(error);
  }
  void print(const std::string& scene, const std::string& who) const {
    std::printf("%-34s %-14s %8.4f %8.4f %8.4f  %5.1f %%  %6.2f\n", scene.c_str(), who.c_str(), quantile(errors, 0.5),
                quantile(errors, 0.95), errors.empty() ? NAN : *std::max_element(errors.begin(), errors.end()),
                100.0 * kept / std::max(1, images), quantile(times, 0.5));
    std::fflush(stdout);
  }
};

motion::MotionConfig configOf(Model model, bool half) {
  motion::MotionConfig config;
  config.model = model;
  if (half) config.max_pixels = 80000;
  return config;
}

// Trials of four images with one motion, `foreign` of the gradient energy moving otherwise. The first pair has no image
// before it: it is told apart.
void accuracy(Model model, const cv::Size& size, bool half, double foreign, int trials) {
  Measured first, later;
  const std::vector<FlowPeer> peers = flowPeers(model);
  std::vector<Measured> others(peers.size());
  std::mt19937 random(7);
  for (int k = 0; k < trials; ++k) {
    const Eigen::Matrix3d step = randomMotion(model, size, random);
    std::vector<Eigen::Matrix3d> motions = {Eigen::Matrix3d::Identity()};
    for (int i = 0; i < 3; ++i) motions.push_back(step * motions.back());
    const MotionScene scene = movingScene(size, motions, foreign, random);
    DominantMotion ours(configOf(model, half));
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
      double begin = cpuTime();
      const motion::MotionResult& result = ours.track(scene.images[i], kPeriod * static_cast<double>(i));
      const double seconds = cpuTime() - begin;
      if (i == 0) continue;
      (i == 1 ? first : later).add(result.state == State::kTracking, motionError(result.g, step, size), seconds);
      for (std::size_t p = 0; p < peers.size() && i > 1; ++p) {
        begin = cpuTime();
        const Eigen::Matrix3d g = peers[p].motion(scene.images[i - 1], scene.images[i]);
        const double taken = cpuTime() - begin;
        others[p].add(true, motionError(g, step, size), taken);
      }
    }
  }
  char name[80];
  std::snprintf(name, sizeof(name), "%s %dx%d%s, %.0f %% foreign", nameOf(model), size.width, size.height,
                half ? " halved" : "", 100.0 * foreign);
  first.print(name, "ours, first");
  later.print(name, "ours");
  for (std::size_t p = 0; p < peers.size(); ++p) others[p].print(name, peers[p].name);
}

// The motion since the first image: of every image to the next, one after the other, and by the anchor.
void drift(const cv::Size& size, int images, double foreign) {
  std::mt19937 random(11);
  const geometry::Rectangle frame{0.0, 0.0, static_cast<double>(size.width), static_cast<double>(size.height)};
  std::vector<Eigen::Matrix3d> motions;
  for (int k = 0; k < images; ++k) {
    motion::MotionField field;
    field.centre = frame.centre();
    const double t = 2.0 * M_PI * k / 125.0;
    field.a << 30.0 * std::sin(t), 20.0 * std::sin(1.3 * t), 0.03 * std::sin(0.7 * t), 0.03 * std::sin(t),
        -0.03 * std::sin(t), 0.03 * std::sin(0.7 * t), 4e-5 * std::sin(0.5 * t), 4e-5 * std::sin(0.8 * t);
    motions.push_back(motion::homographyOf(field));
  }
  const MotionScene scene = movingScene(size, motions, foreign, random);
  motion::AnchoredMotion ours;
  Measured composed, anchored;
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < scene.images.size(); ++k) {
    const double begin = cpuTime();
    const motion::AnchoredResult& result = ours.track(scene.images[k], kPeriod * static_cast<double>(k));
    const double seconds = cpuTime() - begin;
    if (k == 0) continue;
    g = ours.step().g * g;
    composed.add(ours.step().state == State::kTracking, motionError(g, scene.truth[k], size), seconds);
    anchored.add(result.anchored, motionError(result.g, scene.truth[k], size), seconds);
  }
  char name[80];
  std::snprintf(name, sizeof(name), "%d images, %.0f %% foreign", images, 100.0 * foreign);
  composed.print(name, "image to image");
  anchored.print(name, "by the anchor");
  std::printf("%-34s at the end: image to image %.4f, by the anchor %.4f\n", name, composed.errors.back(),
              anchored.errors.back());
}

// Forward and backward: g from an image to the next, and back from there, do nothing together.
void film(const std::string& path, const std::string& roi, int limit) {
  Sequence images(path);
  const Model model = Model::kQuadratic;
  const std::vector<FlowPeer> peers = flowPeers(model);
  std::vector<Measured> others(peers.size());
  Measured ours, regions;
  DominantMotion forward;
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  std::vector<double> shares;
  std::optional<Eigen::Vector2d> centre;
  cv::Mat image, last;
  const geometry::Rectangle region = roi.empty() ? geometry::Rectangle() : parseRoi(roi);
  for (int k = 0; (limit == 0 || k < limit) && images.next(image); ++k) {
    const double stamp = kPeriod * k;
    double begin = cpuTime();
    const motion::MotionResult result = forward.track(image, stamp);
    const double seconds = cpuTime() - begin;
    std::optional<Eigen::Vector2d> now;
    if (!roi.empty()) {
      const tracking::TrackResult& told = k == 0 ? tracker.select(image, stamp, region) : tracker.track(image, stamp);
      if (told.state == tracking::State::kTracking) now = geometry::apply(told.g, region.centre());
    }
    if (k > 0) {
      DominantMotion backward;
      backward.begin(image, 0.0);
      const motion::MotionResult back = backward.track(last, kPeriod);
      const bool both = result.state == State::kTracking && back.state == State::kTracking;
      ours.add(both, motionError(back.g * result.g, Eigen::Matrix3d::Identity(), image.size()), seconds);
      if (result.state == State::kTracking) shares.push_back(result.share);
      if (centre && now)
        regions.add(result.state == State::kTracking, (geometry::apply(result.g, *centre) - *now).norm(), 0.0);
      for (std::size_t p = 0; p < peers.size(); ++p) {
        begin = cpuTime();
        const Eigen::Matrix3d there = peers[p].motion(last, image);
        const double taken = cpuTime() - begin;
        const Eigen::Matrix3d again = peers[p].motion(image, last);
        others[p].add(true, motionError(again * there, Eigen::Matrix3d::Identity(), image.size()), taken);
      }
    }
    centre = now;
    last = image.clone();
  }
  const std::string name = images.name() + (roi.empty() ? "" : " " + roi);
  ours.print(name, "ours");
  for (std::size_t p = 0; p < peers.size(); ++p) others[p].print(name, peers[p].name);
  if (!roi.empty()) regions.print(name, "region's centre");
  std::printf("%-34s share that follows: median %.2f, 5 %% %.2f\n", name.c_str(), quantile(shares, 0.5),
              quantile(shares, 0.05));
}

int measure(int argc, char** argv) {
  namespace po = boost::program_options;
  int trials = 0, images = 0, limit = 0;
  std::vector<std::string> films;
  po::options_description options(
      "bench_motion [FILM[:x,y,w,h]...]: dominant motion on drawn pictures, or on films. Errors in px, root mean "
      "square "
      "over the image, on films of forward and backward motion together; beside it how far a region's centre, by the "
      "region tracker, moves otherwise");
  options.add_options()("help", "this text")("films", po::value(&films), "FILM[:x,y,w,h], a region in its first image")(
      "trials", po::value(&trials)->default_value(40), "of each scene")(
      "images", po::value(&images)->default_value(250), "in a row, for the drift")(
      "limit", po::value(&limit)->default_value(0), "so many images of a film, 0: all");
  if (const auto status = parse(argc, argv, options, "films", -1, [&] { return trials > 0; })) return *status;
  std::printf("%-34s %-14s %8s %8s %8s  %7s  %6s\n", "scene", "by", "median", "95 %", "worst", "kept", "cpu ms");
  for (const std::string& each : films) {
    const std::size_t colon = each.rfind(':');
    film(each.substr(0, colon), colon == std::string::npos ? "" : each.substr(colon + 1), limit);
  }
  if (!films.empty()) return 0;
  for (const Model model : {Model::kQuadratic, Model::kAffine, Model::kConstant}) {
    for (const bool half : {false, true}) {
      for (const double foreign : {0.0, 0.4}) accuracy(model, {640, 480}, half, foreign, trials);
    }
  }
  drift({640, 480}, images, 0.0);
  drift({640, 480}, images, 0.2);
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_motion", [&] { return laparoscope_servo::bench::measure(argc, argv); });
}
