// What the trackers of features, models and instruments hold, in images of 1920x1080, and whether it grows: the
// resident memory of the process, MB, before a tracker is made, after its first images, and after all of them.
#include <malloc.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/support/arguments.h"
#include "laparoscope_servo/features/dot_feature_tracker.h"
#include "laparoscope_servo/features/edge_feature_tracker.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "laparoscope_servo/model/instruments.h"
#include "laparoscope_servo/model/model_tracker.h"
#include "laparoscope_servo/motion/motion_feature_tracker.h"
#include "laparoscope_servo/tracking/contour_texture.h"
#include "test/support/contour_scene.h"
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

const Eigen::Vector2d kCorner(800.0, 400.0);  // px, where a small picture lies in the large one

cv::Mat enlarged(const cv::Mat& picture) {
  cv::Mat image(1080, 1920, CV_8UC1, cv::Scalar(90));
  picture.copyTo(
      image({cv::Point(static_cast<int>(kCorner.x()), static_cast<int>(kCorner.y())), cv::Size(picture.size())}));
  return image;
}

// A dot, an edge and a piece of texture, which move together.
std::vector<cv::Mat> things() {
  const cv::Mat1f texture = test::texture({70, 70}, 110.0, 25.0, 2.0, 7);
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < kPictures; ++k) {
    const test::Region dot = test::ellipse({90.0 + k, 50.0}, 9.0, 9.0, 0.0), half = test::halfPlane(220.0 + k, 0.0);
    test::EdgeScene scene;
    scene.size = {320, 240};
    scene.seed = static_cast<unsigned>(k + 1);
    pictures.push_back(enlarged(test::draw(
        scene, [&](const Eigen::Vector2d& p) { return dot(p) || half(p); },
        [&](cv::Mat1f& pixels) { texture.copyTo(pixels(cv::Rect(cv::Point(120 + k, 140), texture.size()))); })));
  }
  return pictures;
}

features::SelectedFeature selected(features::FeatureKind kind, std::vector<Eigen::Vector2d> points) {
  features::SelectedFeature feature;
  feature.id = "thing";
  feature.kind = kind;
  for (Eigen::Vector2d& point : points) point += kCorner;
  feature.points = std::move(points);
  return feature;
}

void runFeatures(const char* name, const std::vector<cv::Mat>& pictures, int images,
                 const std::function<std::unique_ptr<features::FeatureTracker>()>& make,
                 const features::SelectedFeature& feature) {
  const double before = residentMegabytes();
  const std::unique_ptr<features::FeatureTracker> tracker = make();
  tracker->select(pictures[0], 0.0, {feature}, {});
  run(name, pictures, images, before, [&](const cv::Mat& image, double stamp) {
    return tracker->track(image, stamp, {}).state == features::State::kTracking;
  });
}

void runContour(int images) {
  test_support::ContourScene::Look look;
  look.texture = 12.0;
  const test_support::ContourScene scene(look);
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < kPictures; ++k) pictures.push_back(enlarged(scene.image(0.5 * k, static_cast<unsigned>(k + 1))));
  features::SelectedFeature outline = test_support::ContourScene::selection()[0];
  for (Eigen::Vector2d& point : outline.points) point += kCorner;
  runFeatures(
      "contour", pictures, images, [] { return std::make_unique<tracking::ContourTextureTracker>(); }, outline);
}

void runMotion(int images) {
  const cv::Mat tissue = test::tissue({1920, 1080}, 3);
  std::vector<cv::Mat> pictures;
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  for (int k = 0; k < kPictures; ++k, shift(0, 2) += 2.0)
    pictures.push_back(test::view(tissue, shift, 1.0, 0.0, 2.0, static_cast<unsigned>(k + 1)));
  runFeatures(
      "motion", pictures, images, [] { return std::make_unique<motion::MotionFeatureTracker>(); },
      selected(features::FeatureKind::kMotion, {}));
}

int measure(int argc, char** argv) {
  int images = 0;
  std::string only;
  boost::program_options::options_description options(
      "bench_memory: what trackers hold at 1920x1080, and whether it grows");
  options.add_options()("help", "this text")("images", boost::program_options::value(&images)->default_value(10000),
                                             "shown to each tracker")(
      "only", boost::program_options::value(&only), "dots, edges, points, contour, motion, model or instrument alone");
  if (const auto status = parse(argc, argv, options, "images", 1, [&] { return images > kSettled; })) return *status;
  const auto wanted = [&only](const char* name) { return only.empty() || only == name; };
  std::cout << "tracker     first MB growth MB   tracked of " << images << '\n';
  using features::FeatureKind;
  if (wanted("dots"))
    runFeatures(
        "dots", things(), images, [] { return std::make_unique<features::DotFeatureTracker>(); },
        selected(FeatureKind::kPoint, {{90.0, 50.0}}));
  if (wanted("edges"))
    runFeatures(
        "edges", things(), images, [] { return std::make_unique<features::EdgeFeatureTracker>(); },
        selected(FeatureKind::kLine, {{220.0, 30.0}, {220.0, 210.0}}));
  if (wanted("points"))
    runFeatures(
        "points", things(), images, [] { return std::make_unique<features::PointFeatureTracker>(); },
        selected(FeatureKind::kPoint, {{155.0, 175.0}}));
  if (wanted("contour")) runContour(images);
  if (wanted("motion")) runMotion(images);
  if (wanted("model")) {
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
  if (wanted("instrument")) {
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
