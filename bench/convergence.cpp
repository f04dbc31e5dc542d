// From how far off alignment converges, as in the papers on ESM: the ROI's corners are displaced by normal noise, or
// the whole image by a shift, and counted is the share of trials that end with every corner within 1 px. Each trial is
// a new view of the scene, with noise of its own; everybody starts from the identity.
#include <boost/program_options.hpp>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>

#include "bench/support/arguments.h"
#include "bench/support/contestant.h"
#include "bench/support/json.h"
#include "bench/support/sequence.h"
#include "bench/support/synthetic.h"
#include "laparoscope_servo/tracking/esm.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kConverged = 1.0;  // px
constexpr double kNoise = 2.0;      // grey levels

// ESM alone, without gates and states.
class Aligner : public Contestant {
 public:
  Aligner(std::string name, const tracking::EsmConfig& config)
      : name_(std::move(name)), config_(config), esm_(config) {}
  std::string name() const override { return name_; }
  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    pyramid_.build(image, cv::Rect(0, 0, image.cols, image.rows), config_.levels, image::kLuma);
    esm_.setReference(pyramid_, roi);
  }
  Verdict track(const cv::Mat& image) override {
    pyramid_.build(image, cv::Rect(0, 0, image.cols, image.rows), config_.levels, image::kLuma);
    esm_.forgetLight();
    const tracking::EsmResult result = esm_.align(pyramid_, tracking::EsmState());
    return {result.state.g, result.status == tracking::EsmStatus::kConverged};
  }

 private:
  std::string name_;
  tracking::EsmConfig config_;
  tracking::Esm esm_;
  image::RegionPyramid pyramid_;
};

std::vector<std::unique_ptr<Contestant>> aligners(int max_iterations, bool peers) {
  std::vector<std::unique_ptr<Contestant>> all;
  tracking::EsmConfig config;
  if (max_iterations > 0) config.max_iterations = max_iterations;
  config.levels = 1;
  all.push_back(std::make_unique<Aligner>("esm_1_level", config));
  config.levels = 3;
  all.push_back(std::make_unique<Aligner>("esm_3_levels", config));
  // As the papers have it: neither light nor weights.
  config.robust = false;
  config.light = tracking::Light::kConstant;
  all.push_back(std::make_unique<Aligner>("plain_esm_3_levels", config));
  config.levels = 1;
  all.push_back(std::make_unique<Aligner>("plain_esm_1_level", config));
  all.push_back(makeOurs());
  if (!peers) return all;
  all.push_back(makeEcc());
  all.push_back(makeKlt());
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  all.push_back(makeVispTuned(1));
  all.push_back(makeVispTuned(3));
#endif
  return all;
}

struct Curve {
  std::string kind;  // "corners" or "translation"
  std::vector<double> distance;
  std::map<std::string, std::vector<double>> share;     // that converged
  std::map<std::string, std::vector<double>> mistaken;  // that did not, and claim it
};

Curve measure(const std::string& kind, const std::vector<double>& distances, int trials, const cv::Mat& scene,
              const geometry::Rectangle& roi, std::vector<std::unique_ptr<Contestant>>& contestants, unsigned seed) {
  Curve curve;
  curve.kind = kind;
  curve.distance = distances;
  std::mt19937 random(seed);
  for (const double distance : distances) {
    std::map<std::string, int> converged, mistaken;
    for (int trial = 0; trial < trials; ++trial) {
      const Eigen::Matrix3d truth =
          kind == "corners" ? displacedCorners(roi, distance, random) : displaced(distance, random);
      const cv::Mat reference = view(scene, Eigen::Matrix3d::Identity(), kNoise, random);
      const cv::Mat image = view(scene, truth, kNoise, random);
      for (const auto& contestant : contestants) {
        contestant->select(reference, roi);
        const Verdict verdict = contestant->track(image);
        const bool right = cornerError(verdict.g, truth, roi) < kConverged;
        converged[contestant->name()] += right ? 1 : 0;
        mistaken[contestant->name()] += verdict.claims && !right ? 1 : 0;
      }
    }
    std::cout << kind << ' ' << std::setw(5) << distance << " px:";
    for (const auto& contestant : contestants) {
      const std::string name = contestant->name();
      curve.share[name].push_back(static_cast<double>(converged[name]) / trials);
      curve.mistaken[name].push_back(static_cast<double>(mistaken[name]) / trials);
      std::cout << "  " << name << ' ' << std::fixed << std::setprecision(3) << curve.share[name].back();
    }
    std::cout << std::defaultfloat << std::endl;
  }
  return curve;
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string input, file, corners, shifts;
  int trials = 200, max_iterations = 0;
  double side = 100.0;
  unsigned seed = 1;
  po::options_description options("Share of alignments that converge. bench_convergence [options] [FOLDER]");
  options.add_options()("help", "this text")  //
      ("sequence", po::value(&input),
       "folder whose first image is the scene; without one a synthetic scene is used")                           //
      ("side", po::value(&side)->default_value(100.0), "px, of the ROI: a square in the middle of the scene's")  //
      ("corners", po::value(&corners)->default_value("1:20"), "px, FIRST:LAST[:STEP], noise of the corners")     //
      ("shifts", po::value(&shifts)->default_value("10:40:5"), "px, FIRST:LAST[:STEP], translation")             //
      ("trials", po::value(&trials)->default_value(200), "for each distance")                                    //
      ("iterations", po::value(&max_iterations), "per level, for ESM alone; by default the configuration's")     //
      ("no-peers", "this package's only")                                                                        //
      ("seed", po::value(&seed)->default_value(1), "of the noise")                                               //
      ("json", po::value(&file), "write everything there");
  po::positional_options_description positions;
  positions.add("sequence", 1);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(options).positional(positions).run(), given);
  po::notify(given);
  if (given.count("help") > 0 || trials < 1) {
    std::cout << options;
    return given.count("help") > 0 ? 0 : 2;
  }
  cv::Mat scene = syntheticTissue(cv::Size(640, 480), 1);
  geometry::Rectangle roi = {220.0, 140.0, 200.0, 200.0};
  std::string name = "synthetic";
  if (!input.empty()) {
    Sequence sequence(input);
    if (!sequence.next(scene)) throw std::runtime_error(input + ": no image");
    if (sequence.hasRoi()) roi = sequence.roi();
    name = sequence.name();
  }
  roi = middle(roi, side);
  std::vector<std::unique_ptr<Contestant>> contestants = aligners(max_iterations, given.count("no-peers") == 0);
  std::vector<Curve> curves;
  curves.push_back(measure("corners", parseRange(corners), trials, scene, roi, contestants, seed));
  curves.push_back(measure("translation", parseRange(shifts), trials, scene, roi, contestants, seed + 1));

  if (file.empty()) return 0;
  std::ofstream stream(file);
  if (!stream) throw std::runtime_error(file + ": cannot be written");
  JsonWriter json(stream);
  json.beginObject();
  json.value("scene", name);
  json.value("side", roi.width);
  json.value("trials", trials);
  json.beginArray("curves");
  for (const Curve& curve : curves) {
    json.beginObject();
    json.value("kind", curve.kind);
    json.values("distance", curve.distance);
    json.beginObject("share");
    for (const auto& [who, share] : curve.share) json.values(who, share);
    json.end();
    json.beginObject("mistaken");
    for (const auto& [who, share] : curve.mistaken) json.values(who, share);
    json.end();
    json.end();
  }
  json.end();
  json.end();
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_convergence",
                                       [&] { return laparoscope_servo::bench::program(argc, argv); });
}
