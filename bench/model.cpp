// The tracker of models beside ViSP's, on one thread, in one run: on drawn images, whose poses are known, and on ViSP's
// images of a cube and a cylinder. Times are of the processor.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "bench/support/arguments.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/model/model_tracker.h"
#include "test/support/synthetic_model.h"
#include "test/support/temporary_folder.h"
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
#include "bench/support/visp_model.h"
#endif

namespace laparoscope_servo::bench {

namespace {

using Poses = std::vector<Eigen::Isometry3d>;

constexpr double kWrong = 5.0;  // px at the worst corner
constexpr double kPeriod = 0.04;
constexpr int kVispRange = 7;        // px: that of the cube's settings
constexpr int kVispStartRange = 20;  // where the start is off
constexpr int kVispRounds = 5;       // of tracking on the image of the start: one round is one step of its pyramid

struct Scene {
  std::string name, path;  // of the .cao file
  std::shared_ptr<const model::CadModel> model;
  geometry::PinholeCamera camera;
  std::vector<cv::Mat> images;
  Poses poses;  // the truth, or nothing
};

// The worst of the first eight points, the cube's corners, px.
double cornerError(const Scene& scene, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < 8; ++k) {
    const Eigen::Vector3d p = scene.camera.matrix() * (a * scene.model->points[k]);
    const Eigen::Vector3d q = scene.camera.matrix() * (b * scene.model->points[k]);
    worst = std::max(worst, (p.hnormalized() - q.hnormalized()).norm());
  }
  return worst;
}

// What each tracker is asked: to start, and then each image. False: it claims nothing.
struct Contestant {
  std::string name;
  std::function<bool(const cv::Mat&, const Eigen::Isometry3d&)> select;
  std::function<bool(const cv::Mat&)> track;
  std::function<Eigen::Isometry3d()> pose;
};

std::vector<Contestant> contestants(const Scene& scene, int visp_range, double& stamp) {
  std::vector<Contestant> result;
  auto ours = std::make_shared<model::ModelTracker>(scene.model, scene.camera);
  result.push_back(
      {"ours",
       [ours, &stamp](const cv::Mat& image, const Eigen::Isometry3d& pose) {
         try {
           ours->select(image, stamp, pose);
           return true;
         } catch (const std::invalid_argument&) {
           return false;
         }
       },
       [ours, &stamp](const cv::Mat& image) { return ours->track(image, stamp).state == features::State::kTracking; },
       [ours] { return ours->result().camera_T_object; }});
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  auto visp = std::make_shared<VispModel>(scene.path, scene.camera, visp_range);
  result.push_back({"vpMbGeneric",
                    [visp](const cv::Mat& image, const Eigen::Isometry3d& pose) { return visp->select(image, pose); },
                    [visp](const cv::Mat& image) { return visp->track(image); }, [visp] { return visp->pose(); }});
#else
  static_cast<void>(visp_range);
#endif
  return result;
}

void follow(const Scene& scene, const Eigen::Isometry3d& start) {
  double stamp = 0.0;
  const std::vector<Contestant> all = contestants(scene, kVispRange, stamp);
  struct Numbers {
    std::vector<double> errors, ms;
    int kept = 0, wrong = 0, silent = 0;
  };
  std::vector<Numbers> numbers(all.size());
  for (std::size_t k = 0; k < scene.images.size(); ++k) {
    stamp = kPeriod * static_cast<double>(k);
    std::vector<bool> claims(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t c = (i + k) % all.size();
      const double begin = cpuTime();
      claims[c] = k == 0 ? all[c].select(scene.images[k], start) : all[c].track(scene.images[k]);
      if (k > 0) numbers[c].ms.push_back(1e3 * (cpuTime() - begin));
    }
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (!claims[c]) {
        ++numbers[c].silent;
        continue;
      }
      // Without a truth: how far it is from what ours says.
      const Eigen::Isometry3d truth = scene.poses.empty() ? all[0].pose() : scene.poses[k];
      const double error = cornerError(scene, all[c].pose(), truth);
      numbers[c].errors.push_back(error);
      ++(error < kWrong ? numbers[c].kept : numbers[c].wrong);
    }
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Numbers& n = numbers[c];
    std::cout << std::left << std::setw(26) << scene.name << std::setw(13) << all[c].name << std::right << std::fixed
              << std::setprecision(3) << std::setw(9) << quantile(n.errors, 0.5) << std::setw(9)
              << quantile(n.errors, 0.95) << std::setw(7) << n.kept << std::setw(7) << n.wrong << std::setw(7)
              << n.silent << std::setw(9) << quantile(n.ms, 0.5) << std::setw(9) << quantile(n.ms, 0.95) << std::endl;
  }
}

// Turned about the model's centre by up to so much about each axis of the camera, evenly.
Eigen::Isometry3d turned(const Scene& scene, const Eigen::Isometry3d& truth, double degrees, std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-degrees * M_PI / 180.0, degrees * M_PI / 180.0);
  const double x = angle(random), y = angle(random), z = angle(random);
  Eigen::Isometry3d result = truth;
  result.linear() = geometry::so3Exp({x, y, z}) * truth.linear();
  result.translation() = truth * scene.model->centre - result.linear() * scene.model->centre;
  return result;
}

void start(const Scene& scene, int starts) {
  for (const double degrees : {12.0, 20.0, 30.0}) {
    std::mt19937 random(11);
    struct Numbers {
      std::vector<double> ms;
      int right = 0, wrong = 0;
    };
    std::vector<Numbers> numbers;
    std::vector<std::string> names;
    for (int k = 0; k < starts; ++k) {
      const std::size_t view = static_cast<std::size_t>(k) % scene.images.size();
      const Eigen::Isometry3d from = turned(scene, scene.poses[view], degrees, random);
      double stamp = 0.0;
      const std::vector<Contestant> all = contestants(scene, kVispStartRange, stamp);
      numbers.resize(all.size());
      names.resize(all.size());
      for (std::size_t c = 0; c < all.size(); ++c) {
        names[c] = all[c].name;
        const double begin = cpuTime();
        bool claims = all[c].select(scene.images[view], from);
        for (int i = 0; c > 0 && claims && i < kVispRounds; ++i) claims = all[c].track(scene.images[view]);
        numbers[c].ms.push_back(1e3 * (cpuTime() - begin));
        if (!claims) continue;
        ++(cornerError(scene, all[c].pose(), scene.poses[view]) < kWrong ? numbers[c].right : numbers[c].wrong);
      }
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      const Numbers& n = numbers[c];
      std::cout << std::left << std::setw(26) << scene.name << std::setw(13) << names[c] << std::right << std::fixed
                << std::setprecision(0) << std::setw(6) << degrees << std::setprecision(1) << std::setw(9)
                << 100.0 * n.right / starts << std::setw(9) << 100.0 * n.wrong / starts << std::setw(10)
                << 100.0 * (starts - n.right - n.wrong) / starts << std::setw(9) << quantile(n.ms, 0.5) << std::setw(9)
                << quantile(n.ms, 0.95) << std::endl;
    }
  }
}

Scene drawn(const std::string& name, const std::string& text, const std::string& folder, double texture, int images,
            const std::function<Eigen::Isometry3d(const model::CadModel&, int)>& pose) {
  Scene scene;
  scene.name = name;
  scene.path = folder + "/" + (text == test::kCube ? "cube" : "cube_and_tube") + ".cao";
  std::ofstream(scene.path) << text;
  scene.model = test::modelOf(text);
  scene.camera = {547.0, 547.0, 319.5, 239.5};
  test::ModelScene look;
  look.camera = scene.camera;
  look.size = {640, 480};
  look.texture = look.clutter = texture;
  const test::ModelRenderer renderer(*scene.model, look);
  for (int k = 0; k < images; ++k) {
    scene.poses.push_back(pose(*scene.model, k));
    scene.images.push_back(renderer.draw(scene.poses.back(), static_cast<unsigned>(k + 1)));
  }
  return scene;
}

Eigen::Isometry3d moving(const model::CadModel& model, int k) {
  Eigen::Isometry3d pose = test::viewOf(model, 0.6 + 0.08 * std::sin(k / 25.0), 0.6 + 0.4 * std::sin(k / 30.0),
                                        0.6 + 0.2 * std::sin(k / 20.0));
  pose.translation().x() += 0.04 * std::sin(k / 15.0);
  pose.translation().y() += 0.03 * std::sin(k / 11.0);
  return pose;
}

Eigen::Isometry3d standing(const model::CadModel& model, int k) {
  return test::viewOf(model, 0.55 + 0.02 * k, 0.2 + 0.15 * k, 0.45 + 0.04 * k);
}

// ViSP's images; the poses are those of ours when it follows them from the pose that comes with them.
Scene real(const std::string& folder, const std::string& name, int images, Eigen::Isometry3d& start_pose) {
  Scene scene;
  scene.name = "ViSP's images, " + std::string(name == "cube" ? "cube" : "both");
  scene.path = folder + "/" + name + ".cao";
  scene.model = model::readCadModel(scene.path);
  scene.camera = {547.7367575, 542.0744058, 338.7036994, 234.5083345};
  std::ifstream file(folder + "/cube.0.pos");
  Eigen::Vector3d t, r;
  for (Eigen::Vector3d* v : {&t, &r}) file >> v->x() >> v->y() >> v->z();
  start_pose = Eigen::Isometry3d::Identity();
  start_pose.linear() = geometry::so3Exp(r);
  start_pose.translation() = t;
  for (int k = 0; k < images; ++k) {
    std::ostringstream image;
    image << folder << "/cube/image" << std::setw(4) << std::setfill('0') << k << ".pgm";
    scene.images.push_back(cv::imread(image.str(), cv::IMREAD_GRAYSCALE));
    if (scene.images.back().empty()) throw std::runtime_error(image.str() + " cannot be read");
  }
  return scene;
}

// Every twentieth image, where ours is TRACKING, with its pose.
Scene viewsOf(const Scene& scene, const Eigen::Isometry3d& start_pose) {
  Scene result = scene;
  result.images.clear();
  model::ModelTracker tracker(scene.model, scene.camera);
  tracker.select(scene.images[0], 0.0, start_pose);
  for (std::size_t k = 0; k < scene.images.size(); ++k) {
    if (k > 0) tracker.track(scene.images[k], kPeriod * static_cast<double>(k));
    if (k % 20 != 0 || tracker.result().state != features::State::kTracking) continue;
    result.images.push_back(scene.images[k]);
    result.poses.push_back(tracker.result().camera_T_object);
  }
  return result;
}

int measure(int argc, char** argv) {
  int images = 0, starts = 0;
  std::string folder;
  boost::program_options::options_description options("bench_model: models followed and started, beside ViSP's");
  options.add_options()("help", "this text")("images", boost::program_options::value(&images)->default_value(200),
                                             "of each scene")(
      "starts", boost::program_options::value(&starts)->default_value(200), "of each scene and angle")(
      "visp-images",
      boost::program_options::value(&folder)->default_value("/usr/share/visp-images-data/ViSP-images/mbt"),
      "where cube.cao and its images are; without them, only what is drawn");
  if (const auto status = parse(argc, argv, options, "images, starts", 1, [&] { return images > 1 && starts > 0; })) {
    return *status;
  }
  const test_support::TemporaryFolder temporary;
  const bool has_images = std::ifstream(folder + "/cube.cao").good();
  if (!has_images) std::cout << folder << " has no cube.cao: only drawn images\n";
  const struct {
    const char* name;
    std::string text;
    double texture;
  } kScenes[] = {{"cube", test::kCube, 0.0},
                 {"cube, textured", test::kCube, 15.0},
                 {"cube and tube", test::kCubeAndTube, 0.0},
                 {"cube and tube, textured", test::kCubeAndTube, 15.0}};
  std::cout << "scene                     tracker      corners [px]  p95   kept  wrong silent cpu [ms]      p95\n";
  for (const auto& s : kScenes) {
    const Scene scene = drawn(s.name, s.text, temporary.path(), s.texture, images, moving);
    follow(scene, scene.poses[0]);
  }
  Eigen::Isometry3d start_pose;
  for (const char* name : {"cube", "cube_and_cylinder"}) {
    if (!has_images) continue;
    const Scene scene = real(folder, name, std::min(images, 217), start_pose);
    follow(scene, start_pose);
  }
  std::cout
      << "\nscene                     tracker      off by    right    wrong   refused cpu [ms]      p95   [deg, %]\n";
  for (const auto& s : kScenes) start(drawn(s.name, s.text, temporary.path(), s.texture, 10, standing), starts);
  for (const char* name : {"cube", "cube_and_cylinder"}) {
    if (!has_images) continue;
    const Scene scene = real(folder, name, 201, start_pose);
    start(viewsOf(scene, start_pose), starts);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_model", [&] { return laparoscope_servo::bench::measure(argc, argv); });
}
