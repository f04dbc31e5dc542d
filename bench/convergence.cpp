// From how far off alignment converges, as in the papers on ESM: the ROI's corners are displaced by normal noise, or
// the whole image by a shift, and counted is the share of trials that end with every corner within 1 px. Each trial is
// a new view of the scene, with noise of its own; everybody starts from the identity, is given the same images, and as
// much of them as it can use.
#include <boost/program_options.hpp>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>

#include "bench/support/aligners.h"
#include "bench/support/arguments.h"
#include "bench/support/contestant.h"
#include "bench/support/crop.h"
#include "bench/support/sequence.h"
#include "bench/support/synthetic.h"
#include "ros/common/json_writer.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kConverged = 1.0;       // px
constexpr double kNoise = 2.0;           // grey levels
constexpr double kSurroundings = 120.0;  // px on each side of the ROI
constexpr int kPatience = 50;  // iterations that plain ESM and ECC have at a level: how far they get, not how fast

// What is looked at, and where.
struct Setting {
  std::string name = "synthetic";
  cv::Mat image;
  geometry::Rectangle roi;
};

Setting settingOf(const std::string& image, const std::string& folder) {
  Setting setting;
  if (!image.empty()) {
    setting.name = image;
    setting.image = readImage(image);
    setting.roi = {0.0, 0.0, static_cast<double>(setting.image.cols), static_cast<double>(setting.image.rows)};
  } else if (!folder.empty()) {
    Sequence sequence(folder);
    setting.name = sequence.name();
    if (!sequence.next(setting.image) || !sequence.hasRoi())
      throw std::runtime_error(folder + ": no image, or no scene.json");
    setting.roi = sequence.roi();
  } else {
    setting.image = syntheticTissue(cv::Size(640, 480), 1);
    setting.roi = {220.0, 140.0, 200.0, 200.0};
  }
  return setting;
}

// The part of the image around the ROI that anybody may need; the ROI is moved along with it.
cv::Mat surroundings(const cv::Mat& image, geometry::Rectangle& roi) {
  const cv::Rect box = boxAround(Eigen::Matrix3d::Identity(), roi, kSurroundings, image.size());
  roi.x -= box.x;
  roi.y -= box.y;
  return image(box).clone();
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

void write(std::ostream& stream, const Setting& setting, double side, int trials, const std::vector<Curve>& curves) {
  JsonWriter json(stream);
  json.beginObject();
  json.value("scene", setting.name);
  json.value("side", side);
  json.value("trials", trials);
  json.beginArray("curves");
  for (const Curve& curve : curves) {
    json.beginObject();
    json.value("kind", curve.kind);
    json.values("distance", curve.distance);
    json.beginObject("share");
    for (const auto& [name, share] : curve.share) json.values(name, share);
    json.end();
    json.beginObject("mistaken");
    for (const auto& [name, share] : curve.mistaken) json.values(name, share);
    json.end();
    json.end();
  }
  json.end();
  json.end();
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string who, input, image, roi_text, file, corners, shifts;
  int trials = 200, max_iterations = 0;
  double side = 100.0;
  unsigned seed = 1;
  po::options_description options("Share of alignments that converge. bench_convergence [options] [FOLDER]");
  options.add_options()("help", "this text")                                                                    //
      ("sequence", po::value(&input), "folder with scene.json, whose first image is the scene")                 //
      ("image", po::value(&image), "or an image file, or FILE@N for image N of a video; else a synthetic one")  //
      ("roi", po::value(&roi_text), "x,y,width,height in it")                                                   //
      ("side", po::value(&side)->default_value(100.0), "px, of the ROI used: a square in the middle of that")   //
      ("corners", po::value(&corners)->default_value("1:20"),
       "px, FIRST:LAST[:STEP], noise of the corners; or none")                                                 //
      ("shifts", po::value(&shifts)->default_value("10:40:5"), "px, FIRST:LAST[:STEP], translation; or none")  //
      ("trials", po::value(&trials)->default_value(200), "for each distance")                                  //
      ("iterations", po::value(&max_iterations), "per level, for ESM alone; by default the configuration's")   //
      ("who", po::value(&who)->default_value("all"),
       "all; own: without peers; parts: ESM with each model of light, with weights and without")  //
      ("seed", po::value(&seed)->default_value(1), "of the noise")                                //
      ("json", po::value(&file), "write everything there");
  const auto complete = [&] { return trials >= 1; };
  if (const auto status = parse(argc, argv, options, "sequence", 1, complete)) return *status;
  const Setting setting = settingOf(image, input);
  geometry::Rectangle roi = roi_text.empty() ? setting.roi : parseRoi(roi_text);
  roi = middle(roi, side);
  const cv::Mat scene = surroundings(setting.image, roi);
  std::vector<std::unique_ptr<Contestant>> contestants = aligners(who, max_iterations);
  std::vector<Curve> curves;
  for (const auto& [kind, range] : {std::pair("corners", corners), std::pair("translation", shifts)}) {
    if (range != "none")
      curves.push_back(measure(kind, parseRange(range), trials, scene, roi, contestants, seed + curves.size()));
  }

  if (file.empty()) return 0;
  std::ofstream stream = create(file);
  write(stream, setting, roi.width, trials, curves);
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_convergence",
                                       [&] { return laparoscope_servo::bench::program(argc, argv); });
}
