// Contour and texture in one minimisation, beside either of them alone: on drawn sequences whose truth is known, each
// with many seeds. Images kept (TRACKING and less than 2 px off), lies (TRACKING and more than that off),
// error, and the processor's time.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/support/arguments.h"
#include "bench/support/contour_scenes.h"
#include "bench/support/cpu_clock.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/contour_texture.h"

namespace laparoscope_servo::bench {

namespace {

using features::State;
using features::TrackedFeature;
using test_support::ContourScene;
using tracking::ContourTextureConfig;
using tracking::ContourTextureTracker;

constexpr int kImages = 100;
constexpr double kLie = 2.0;  // px

struct Way {
  const char* name;
  bool texture, contour;
};
constexpr Way kWays[] = {
    {"contour and texture", true, true}, {"texture (ESM)", true, false}, {"contour (edges)", false, true}};

struct Row {
  int kept = 0, lies = 0, most_lies = 0;  // most_lies: in one sequence
  std::vector<double> errors, times;
};

int run(const std::vector<cv::Mat>& images, const ContourScene& scene, const Way& way, bool verbose, Row& row) {
  ContourTextureConfig config;
  config.texture = way.texture;
  config.contour = way.contour;
  ContourTextureTracker tracker(config);
  tracker.select(images[0], 0.0, ContourScene::selection(), {});
  int kept = 0, lies = 0;
  for (int k = 1; k < kImages; ++k) {
    const double begin = cpuTime();
    const TrackedFeature& told = tracker.track(images[static_cast<std::size_t>(k)], k * 0.04, {}).features.at(0);
    row.times.push_back(1e3 * (cpuTime() - begin));
    const double error = scene.error(told.parameters, k);
    if (verbose) {
      std::printf("%3d %s error %.2f expected %.2f share %.2f %s\n", k, stateName(told.state), error,
                  told.expected_error, told.share, told.reason.c_str());
    }
    if (told.state != State::kTracking) continue;
    row.errors.push_back(error);
    ++(error < kLie ? kept : lies);
  }
  row.kept += kept;
  row.lies += lies;
  row.most_lies = std::max(row.most_lies, lies);
  return kept;
}

void drawn(unsigned from, unsigned to, const std::string& only, bool verbose) {
  std::printf("%-21s %-20s %6s %5s %5s %9s %9s %7s %6s\n", "sequence", "by", "kept", "lies", "worst", "error px",
              "95 % px", "ms", "fewer");
  const std::size_t count = contourCases(from).size();
  for (std::size_t c = 0; c < count; ++c) {
    Row rows[3];
    int fewer = 0;  // sequences of which both together keep fewer images than the better half
    std::string name;
    for (unsigned seed = from; seed <= to; ++seed) {
      const ContourCase each = contourCases(seed)[c];
      name = each.name;
      if (!only.empty() && name != only) break;
      const ContourScene scene(each.look);
      std::vector<cv::Mat> images;
      for (int k = 0; k < kImages; ++k) {
        images.push_back(scene.image(k, static_cast<unsigned>(k + 1), [&](cv::Mat1f& picture) {
          if (k > 0 && each.cover) each.cover(scene, k, picture);
        }));
      }
      int kept[3];
      for (std::size_t w = 0; w < 3; ++w) {
        if (verbose) std::printf("%s seed %u %s\n", name.c_str(), seed, kWays[w].name);
        kept[w] = run(images, scene, kWays[w], verbose, rows[w]);
      }
      fewer += kept[0] < std::max(kept[1], kept[2]) ? 1 : 0;
    }
    for (std::size_t w = 0; w < 3 && !rows[w].times.empty(); ++w) {
      Row& row = rows[w];
      const bool any = !row.errors.empty();
      std::printf("%-21s %-20s %6d %5d %5d %9.3f %9.3f %7.3f", name.c_str(), kWays[w].name, row.kept, row.lies,
                  row.most_lies, any ? robust::nearestRank(row.errors, 0.5) : NAN,
                  any ? robust::nearestRank(row.errors, 0.95) : NAN, robust::nearestRank(row.times, 0.5));
      std::printf(w == 0 ? " %6d\n" : "\n", fewer);
    }
    std::fflush(stdout);
  }
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string seeds = "1:40", only;
  bool verbose = false;
  po::options_description options("bench_contour [options]\n\nContour and texture in one, on drawn sequences");
  options.add_options()("help,h", "this text")("seeds", po::value(&seeds)->default_value(seeds),
                                               "of the sequences, FROM:TO")(
      "only", po::value(&only), "the sequence of this name alone")("verbose", po::bool_switch(&verbose),
                                                                   "every image of every sequence");
  const auto complete = [] { return true; };
  if (const auto status = parse(argc, argv, options, "", 0, complete)) return *status;
  cv::setNumThreads(1);
  const std::vector<double> range = parseRange(seeds);
  drawn(static_cast<unsigned>(range.front()), static_cast<unsigned>(range.back()), only, verbose);
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_contour", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
