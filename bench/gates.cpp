// What each gate of occlusion does, alone and together with the others: how many of the areas that are covered it keeps
// out, how many of the clean ones, and what that does to the estimate. One line per sequence and set of gates.
//
// An area is covered when at least half of it is, and clean when nothing of it is; what lies between counts for
// neither. Areas are counted in the images that the tracker keeps (it says TRACKING, and is right): elsewhere its areas
// lie on other tissue. Clean areas under another light: the sequence's first image, still, as bright as before times
// 0.8 or 1.25, with noise of its own, ten times; counted whatever the tracker says of it.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <fstream>
#include <iostream>

#include "bench/support/arguments.h"
#include "bench/support/configurations.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s, between images
constexpr int kStillImages = 10;
constexpr double kCovered = 0.5;

struct Count {
  int areas = 0;
  int rejected = 0;
  void add(bool is_rejected) {
    ++areas;
    rejected += is_rejected ? 1 : 0;
  }
};

struct Row {
  int frames = 0;
  int lies = 0;
  std::vector<double> error;  // px, of the frames kept
  Count covered, clean;
  double claimed_worst = 0.0;  // px, of the frames claimed
};

Row trackThrough(Sequence& sequence, const tracking::TrackerConfig& config) {
  tracking::RegionTracker tracker(config);
  Row row;
  sequence.rewind();
  cv::Mat image;
  for (std::size_t frame = 0; sequence.next(image); ++frame) {
    if (frame == 0) {
      tracker.select(image, 0.0, sequence.roi());
      continue;
    }
    ++row.frames;
    const tracking::TrackResult result = tracker.track(image, kPeriod * static_cast<double>(frame));
    if (result.state != tracking::State::kTracking) continue;
    const double error = cornerError(result.g, sequence.truth()[frame], sequence.roi());
    row.claimed_worst = std::max(row.claimed_worst, error);
    if (!(error < kLost)) {
      ++row.lies;
      continue;
    }
    row.error.push_back(error);
    const std::vector<double>& truth = sequence.areas()[frame];
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (truth[k] >= kCovered) row.covered.add(result.areas.occluded[k]);
      if (!(truth[k] > 0.0)) row.clean.add(result.areas.occluded[k]);
    }
  }
  return row;
}

Count cleanUnderLight(Sequence& sequence, const tracking::TrackerConfig& config, double gain) {
  sequence.rewind();
  cv::Mat first, lit;
  if (!sequence.next(first)) throw std::runtime_error(sequence.name() + ": no image");
  tracking::RegionTracker tracker(config);
  tracker.select(first, 0.0, sequence.roi());
  cv::RNG random(1);
  cv::Mat grain(first.size(), CV_32FC3);
  Count clean;
  for (int k = 1; k <= kStillImages; ++k) {
    // The first image's own noise is in the reference and here: two images' worth of it makes up for that.
    random.fill(grain, cv::RNG::NORMAL, 0.0, std::sqrt(2.0) * sequence.noise());
    first.convertTo(lit, CV_32FC3, gain);
    lit += grain;
    lit.convertTo(lit, CV_8UC3);
    const tracking::TrackResult result = tracker.track(lit, kPeriod * k);
    for (const bool occluded : result.areas.occluded) clean.add(occluded);
  }
  return clean;
}

void writeRow(std::ostream& out, Sequence& sequence, const NamedConfig& gates) {
  const Row row = trackThrough(sequence, gates.config);
  const Count darker = cleanUnderLight(sequence, gates.config, 0.8);
  const Count brighter = cleanUnderLight(sequence, gates.config, 1.25);
  out << sequence.name() << ',' << gates.name << ',' << row.frames << ',' << row.error.size() << ',' << row.lies << ','
      << mean(row.error) << ',' << quantile(row.error, 1.0) << ',' << row.claimed_worst;
  for (const Count& count : {row.covered, row.clean, darker, brighter}) {
    out << ',' << count.areas << ',' << count.rejected;
  }
  out << '\n' << std::flush;
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> folders;
  std::string file;
  po::options_description options("Each gate of occlusion alone and together, as CSV. bench_gates [options] FOLDER...");
  options.add_options()("help", "this text")  //
      ("sequence", po::value(&folders)->composing(),
       "folder with frames/, truth.csv, areas.csv and scene.json")  //
      ("csv", po::value(&file), "write there instead of to the standard output");
  po::positional_options_description positions;
  positions.add("sequence", -1);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(options).positional(positions).run(), given);
  po::notify(given);
  if (given.count("help") > 0 || folders.empty()) {
    std::cout << options;
    return given.count("help") > 0 ? 0 : 2;
  }
  std::ofstream stream;
  if (!file.empty()) {
    stream.open(file);
    if (!stream) throw std::runtime_error(file + ": cannot be written");
  }
  std::ostream& out = file.empty() ? std::cout : stream;
  out << "sequence,gates,frames,kept,lies,error_mean,error_worst,claimed_worst,covered,covered_rejected,clean,"
         "clean_rejected,darker,darker_rejected,brighter,brighter_rejected\n";
  for (const std::string& folder : folders) {
    Sequence sequence(folder);
    if (!sequence.hasTruth() || !sequence.hasRoi() || sequence.areas().empty())
      throw std::runtime_error(folder + ": no truth.csv, areas.csv or scene.json");
    for (const NamedConfig& gates : gateConfigurations()) writeRow(out, sequence, gates);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_gates", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
