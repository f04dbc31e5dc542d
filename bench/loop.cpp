// The closed loop by images of real tissue: an image of a film is the texture of the tissue before the simulated scope,
// and POINTS, FOLLOW, STABILISE and PARALLEL servo by what its camera renders.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <vector>

#include "bench/support/arguments.h"
#include "bench/support/loop_trace.h"
#include "bench/support/sequence.h"
#include "bench/support/slider.h"
#include "laparoscope_servo/geometry/se3.h"
#include "test/support/image_loop.h"

namespace laparoscope_servo::bench {

namespace {

using servo::ControllerState;
using test::ImageLoop;
using test::SimulatedCart;

constexpr double kDegree = M_PI / 180.0;
constexpr double kHeight = 0.1;   // m, of the tissue that the texture shows: about what the camera sees of it
constexpr double kSettled = 2.0;  // px
constexpr double kImage = SimulatedCart::kImageTicks * SimulatedCart::kTick;  // s

struct Texture {
  std::string name;
  cv::Mat image;
};

// What a run has shown. `errors`: of each image, px or degrees.
struct Run {
  std::vector<double> errors;
  std::string end;  // why it did not go on; empty: it did
  int holds = 0;

  // s, from which on the error stays below the bound; negative: it does not.
  double settled(double bound) const {
    std::size_t k = errors.size();
    while (k > 0 && errors[k - 1] < bound) --k;
    return end.empty() && k < errors.size() ? kImage * static_cast<double>(k) : -1.0;
  }
  double rms(double from) const {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = static_cast<std::size_t>(from / kImage); k < errors.size(); ++k, ++count)
      sum += errors[k] * errors[k];
    return std::sqrt(sum / count);
  }
};

sim::SceneConfig sceneOf(const cv::Mat& texture) {
  sim::SceneConfig scene;
  scene.tissue.width = kHeight * texture.cols / texture.rows;
  return scene;
}

// One image, and its error; false where the loop has ended.
bool advance(ImageLoop& loop, const test::Eye& eye, const std::function<double()>& error, Run& run) {
  const ControllerState before = loop.cart().output.state;
  loop.step(eye);
  run.errors.push_back(error());
  const ControllerState now = loop.cart().output.state;
  if (now == ControllerState::kHold && before == ControllerState::kServo) ++run.holds;
  if (servo::isEngaged(now)) return true;
  run.end = loop.cart().output.reason;
  return false;
}

Run goToPoints(const cv::Mat& texture, const scope::Velocity& start, double seconds, int& tracked, int& selected) {
  ImageLoop loop(sceneOf(texture), texture, servo::Task::kPoints, start);
  const geometry::PinholeCamera camera = loop.camera().config().camera.intrinsics;
  test::PointsEye points(camera, loop.reference(), 60, servo::ControllerConfig());
  const test::Eye eye = [&](const cv::Mat& image, double time) { return points.see(image, time); };
  Run run;
  try {
    loop.step(eye);
  } catch (const std::invalid_argument& error) {
    run.end = error.what();
    return run;
  }
  run.end = loop.engage();
  while (run.end.empty() && loop.cart().time() < seconds)
    if (!advance(
            loop, eye, [&] { return loop.cart().offset(); }, run))
      break;
  tracked = points.tracked();
  selected = points.selected();
  return run;
}

Run follow(const cv::Mat& texture, double seconds, const std::string& pictures) {
  ImageLoop loop(sceneOf(texture), texture, servo::Task::kFollow, {});
  const Slider slider(texture, kHeight);
  const geometry::PinholeCamera camera = loop.camera().config().camera.intrinsics;
  const auto place = [&] { return loop.seenAt(slider.middle(loop.cart().time())); };
  test::ObjectEye object(camera, Slider::regionAbout(place(), camera.fx, loop.camera().config().tissue.distance));
  LoopTrace trace(pictures, "follow", 10);
  const test::Eye eye = [&](const cv::Mat& image, double time) {
    const servo::TaskErrorInput seen = object.see(image, time);
    trace.add(image, time, object.place(), place(), 0.0, object.motion().field.a);
    return seen;
  };
  const auto show = [&] { loop.camera().setTexture(slider.texture(loop.cart().time())); };
  const auto error = [&] { return (place() - camera.matrix().topRightCorner<2, 1>()).norm(); };
  Run run;
  show();
  loop.step(eye);
  run.end = loop.engage();
  while (run.end.empty() && loop.cart().time() < seconds) {
    show();
    if (!advance(loop, eye, error, run)) break;
  }
  return run;
}

// The tissue goes to and fro by `kSway`; `controlled`: the task is engaged.
Run stabilise(const cv::Mat& texture, bool controlled, double seconds, const std::string& pictures) {
  constexpr double kSway = 0.008, kPeriod = 5.0;  // m, s
  const sim::SceneConfig scene = sceneOf(texture);
  ImageLoop loop(scene, texture, servo::Task::kStabilise, {});
  loop.tissue_motion = [](double time) {
    const double phase = 2.0 * M_PI * time / kPeriod;
    return Eigen::Isometry3d(Eigen::Translation3d(kSway * std::sin(phase), 0.5 * kSway * (1.0 - std::cos(phase)), 0.0));
  };
  test::ViewEye view(scene.camera.intrinsics, {scene.camera.width, scene.camera.height});
  const Eigen::Vector2d middle = scene.camera.intrinsics.matrix().topRightCorner<2, 1>();
  LoopTrace trace(pictures, controlled ? "stabilise" : "stabilise_without", 25);
  const test::Eye eye = [&](const cv::Mat& image, double time) {
    const servo::TaskErrorInput seen = view.see(image, time);
    trace.add(image, time, geometry::apply(view.motion().g, middle), loop.seenAt({0.0, 0.0}), 0.0, view.step().field.a);
    return seen;
  };
  const auto error = [&] { return (loop.seenAt({0.0, 0.0}) - middle).norm(); };
  Run run;
  loop.step(eye);
  if (controlled) run.end = loop.engage();
  while (run.end.empty() && loop.cart().time() < seconds) {
    if (controlled && !advance(loop, eye, error, run)) break;
    if (controlled) continue;
    loop.step(eye);
    run.errors.push_back(error());
  }
  return run;
}

// `normal_error`: degrees, once it is known.
Run face(const cv::Mat& texture, double azimuth, double seconds, double& normal_error, const std::string& pictures) {
  sim::SceneConfig scene = sceneOf(texture);
  scene.tissue.tilt_x = 30.0 * kDegree * std::cos(azimuth);
  scene.tissue.tilt_y = 30.0 * kDegree * std::sin(azimuth);
  ImageLoop loop(scene, texture, servo::Task::kParallel, {});
  test::ViewEye view(scene.camera.intrinsics, {scene.camera.width, scene.camera.height});
  const auto error = [&] { return loop.slant() / kDegree; };
  LoopTrace trace(pictures, "parallel", 5);
  const test::Eye eye = [&](const cv::Mat& image, double time) {
    const servo::TaskErrorInput seen = view.see(image, time);
    trace.add(image, time, loop.seenAt({0.0, 0.0}), loop.seenAt({0.0, 0.0}), error(), view.step().field.a);
    return seen;
  };
  Run run;
  loop.step(eye);
  run.end = loop.engage();
  normal_error = std::numeric_limits<double>::quiet_NaN();
  while (run.end.empty() && loop.cart().time() < seconds) {
    if (advance(loop, eye, error, run)) continue;
    const servo::ParallelFigures figures = loop.cart().controller.figures().parallel;
    if (figures.stage != servo::ParallelStage::kAnnounced) break;
    normal_error = geometry::angleBetween(figures.normal, loop.normal()) / kDegree;
    run.end = loop.engage();
    if (run.end.empty()) advance(loop, eye, error, run);
  }
  return run;
}

void measure(const Texture& texture, const std::string& task, int starts, const std::string& pictures) {
  std::mt19937 random(1);
  const auto within = [&](double spread) { return std::uniform_real_distribution<double>(-spread, spread)(random); };
  for (int k = 0; k < starts; ++k) {
    std::printf("%-32s %-10s", texture.name.c_str(), task.c_str());
    Run run;
    if (task == "POINTS") {
      const scope::Velocity start{within(0.1), within(0.07), within(0.2), within(0.01)};
      int tracked = 0, selected = 0;
      run = goToPoints(texture.image, start, 8.0, tracked, selected);
      std::printf("points %2d of %2d, settled to 2 px %5.2f s, rms of the last 2 s %6.2f px", tracked, selected,
                  run.settled(kSettled), run.end.empty() ? run.rms(6.0) : NAN);
    } else if (task == "FOLLOW") {
      run = follow(texture.image, 12.0, pictures);
      std::printf("rms from 3 s on %6.2f px, worst %6.2f px, %5.2f s", run.end.empty() ? run.rms(3.0) : NAN,
                  run.errors.size() > 75 ? *std::max_element(run.errors.begin() + 75, run.errors.end()) : NAN,
                  kImage * static_cast<double>(run.errors.size()));
    } else if (task == "STABILISE") {
      const Run without = stabilise(texture.image, false, 12.0, pictures);
      run = stabilise(texture.image, true, 12.0, pictures);
      std::printf("rms from 3 s on %6.2f px, without the task %6.2f px", run.end.empty() ? run.rms(3.0) : NAN,
                  without.rms(3.0));
    } else {
      double normal_error = 0.0;
      run = face(texture.image, 2.0 * M_PI * k / starts + 0.7, 15.0, normal_error, k == 0 ? pictures : std::string());
      std::printf("normal off by %5.2f, axis at the end %5.2f degrees, below 1 from %5.2f s on", normal_error,
                  run.errors.empty() ? NAN : run.errors.back(), run.settled(1.0));
    }
    std::printf(", holds %d%s%s\n", run.holds, run.end.empty() ? "" : "; ended: ", run.end.c_str());
    std::fflush(stdout);
    if (task == "FOLLOW" || task == "STABILISE") break;  // there is one way only
  }
}

// "IMAGE", "FILM@N", each with ":x,y,w,h" behind it for a part.
Texture textureOf(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string name = text.substr(0, colon);
  cv::Mat image = readImage(name);
  if (colon != std::string::npos) {
    const geometry::Rectangle roi = parseRoi(text.substr(colon + 1));
    const cv::Rect whole(0, 0, image.cols, image.rows);
    const cv::Rect part(static_cast<int>(roi.x), static_cast<int>(roi.y), static_cast<int>(roi.width),
                        static_cast<int>(roi.height));
    if ((part & whole) != part) throw std::invalid_argument(text + ": the part is not within the image");
    image = image(part).clone();
  }
  return {std::filesystem::path(name).filename().string(), image};
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> images, tasks;
  std::string pictures;
  int starts = 0;
  po::options_description options(
      "bench_loop IMAGE[:x,y,w,h] or FILM@N[:x,y,w,h] ...: POINTS, FOLLOW, STABILISE and PARALLEL in the closed loop,\n"
      "with these images, or parts of them, for the texture of the tissue");
  options.add_options()("help", "this text")  //
      ("image", po::value(&images)->composing(), "images; @N: image N of a film")(
          "task", po::value(&tasks)->composing(), "one of these; may be repeated, none: all")(
          "pictures", po::value(&pictures),
          "folder for images and tables of the last image's runs, for survey_figures.py")(
          "starts", po::value(&starts)->default_value(3), "of each texture in POINTS and PARALLEL");
  if (const auto status = parse(argc, argv, options, "image", -1, [&] { return !images.empty() && starts > 0; }))
    return *status;
  if (tasks.empty()) tasks = {"POINTS", "FOLLOW", "STABILISE", "PARALLEL"};
  std::vector<Texture> textures;
  for (const std::string& image : images) textures.push_back(textureOf(image));
  for (const std::string& task : tasks) {
    for (const Texture& texture : textures) measure(texture, task, starts, pictures);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_loop", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
