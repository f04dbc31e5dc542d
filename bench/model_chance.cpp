// What a start of the tracker of models finds where there is no model: the evidence for the best pose, in drawn
// textures and in images of films, by the number of sites that it has. The starts' thresholds have to lie above it.
//
//   bench_model_chance FOLDER FILM...
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/features/edge_fit.h"
#include "model/model_start.h"
#include "test/support/synthetic_model.h"

namespace laparoscope_servo::bench {

namespace {

constexpr std::array<int, 4> kSites = {60, 100, 150, 1000};  // the classes' upper ends

struct Chance {
  int starts = 0, fits = 0, taken = 0;
  std::array<double, kSites.size()> most_per_site{}, most{};  // nats
};

void start(const std::shared_ptr<const model::CadModel>& shape, const geometry::PinholeCamera& camera,
           const cv::Mat& image, const Eigen::Isometry3d& pose, Chance& chance) {
  const model::ModelConfig config;
  model::Outline outline(shape, camera, image.size(), pose);
  features::EdgeFit fit(config.edges);
  const model::StartResult result = model::ModelStart(config).find(image, outline, fit);
  ++chance.starts;
  if (result.report.reason == features::Reason::kNone) ++chance.taken;
  if (result.report.inside == 0 || !(result.report.share >= config.start_share)) return;
  ++chance.fits;
  std::size_t size = 0;
  while (result.report.inside > kSites[size]) ++size;
  chance.most[size] = std::max(chance.most[size], result.report.evidence);
  chance.most_per_site[size] = std::max(chance.most_per_site[size], result.report.evidence / result.report.inside);
}

void print(const std::string& name, const Chance& chance) {
  std::printf("%-34s %6d %6d %6d  ", name.c_str(), chance.starts, chance.fits, chance.taken);
  for (std::size_t k = 0; k < kSites.size(); ++k) std::printf(" %6.2f %5.0f", chance.most_per_site[k], chance.most[k]);
  std::printf("\n");
}

cv::Mat texture(unsigned seed, double scale) {
  cv::Mat1f grain(240, 320);
  cv::RNG random(seed);
  random.fill(grain, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(grain, grain, cv::Size(), scale);
  cv::Mat image;
  grain.convertTo(image, CV_8UC1, 25.0 * 3.545 * scale, 110.0);
  return image;
}

void measure(const std::string& folder, const std::vector<std::string>& films) {
  std::printf("%-34s %6s %6s %6s   most nats per site, and nats, of up to 60, 100, 150 sites, and of more\n", "images",
              "starts", "fits", "taken");
  std::vector<std::shared_ptr<const model::CadModel>> shapes;
  for (const std::string& text : {test::kCube, test::kCubeAndTube}) shapes.push_back(test::modelOf(text));
  const auto both = [&shapes](const cv::Mat& image, double focal_length, double distance, int k, Chance& chance) {
    const geometry::PinholeCamera camera{focal_length, focal_length, 0.5 * image.cols, 0.5 * image.rows};
    for (const auto& shape : shapes)
      start(shape, camera, image, test::viewOf(*shape, distance, 0.2 + 0.4 * k, 0.45 + 0.04 * (k % 10)), chance);
  };
  for (const double scale : {1.5, 3.0, 5.0}) {
    Chance chance;
    for (int k = 1; k <= 40; ++k)
      both(texture(static_cast<unsigned>(k), scale), 300.0, k % 2 == 0 ? 0.42 : 0.62, k, chance);
    print("textures, px " + std::to_string(scale).substr(0, 3), chance);
  }
  for (const std::string& film : films) {
    constexpr int kImages = 10;  // of a film, evenly
    cv::VideoCapture video(folder + "/" + film);
    const double count = video.get(cv::CAP_PROP_FRAME_COUNT);
    Chance chance;
    cv::Mat image;
    for (int k = 0; k < kImages; ++k) {
      video.set(cv::CAP_PROP_POS_FRAMES, std::floor(k * count / kImages));
      if (!video.read(image)) continue;
      for (const double zoom : {0.9, 1.8}) both(image, zoom * image.cols, 0.3 + 0.03 * k, k, chance);
    }
    print(film, chance);
  }
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_model_chance FOLDER FILM...\n");
    return 2;
  }
  cv::setNumThreads(1);
  laparoscope_servo::bench::measure(argv[1], std::vector<std::string>(argv + 2, argv + argc));
  return 0;
}
