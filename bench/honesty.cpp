// What the tracker knows about an estimate, beside how wrong the estimate is: the data to choose the thresholds of the
// state on.
//
// Rows of three sources:
//   sequence  the tracker as configured by default, image by image
//   jump      the tracker, with limits as lax as can be set, selected on the first image and shown a later one that is
//   displaced besides: as if
//             the images between were lost. Badly started alignments converge falsely; these are the negatives
//   esm       ESM with both gates once, from a displaced start, with what only ESM tells (sigma, last step, status)
#include <boost/program_options.hpp>
#include <fstream>
#include <iostream>
#include <limits>

#include "bench/support/arguments.h"
#include "bench/support/configurations.h"
#include "bench/support/gated_esm.h"
#include "bench/support/sequence.h"
#include "bench/support/synthetic.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s, between images
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Row {
  std::string source;
  std::string sequence;
  std::size_t frame = 0;
  double covered = 0.0;      // truth: share of the ROI
  double start_error = 0.0;  // px, before
  double error = 0.0;        // px, after
  int state = 0;
  double zncc = 0.0;
  double corner_error = 0.0;
  double visible_fraction = 0.0;
  int iterations = 0;
  double gain = 1.0;
  double sigma = kUnknown;
  double last_step = kUnknown;
  int status = -1;  // of EsmStatus
};

void writeHeader(std::ostream& out) {
  out << "source,sequence,frame,covered,start_error,error,state,zncc,corner_error,visible_fraction,iterations,gain,"
         "sigma,"
         "last_step,status\n";
}

void write(std::ostream& out, const Row& r) {
  out << r.source << ',' << r.sequence << ',' << r.frame << ',' << r.covered << ',' << r.start_error << ',' << r.error
      << ',' << r.state << ',' << r.zncc << ',' << r.corner_error << ',' << r.visible_fraction << ',' << r.iterations
      << ',' << r.gain << ',' << r.sigma << ',' << r.last_step << ',' << r.status << '\n';
}

void fill(Row& row, const tracking::TrackResult& result) {
  row.state = static_cast<int>(result.state);
  row.zncc = result.zncc;
  row.corner_error = result.corner_error;
  row.visible_fraction = result.visible_fraction;
  row.iterations = result.iterations;
  row.gain = result.gain;
  row.sigma = result.sigma;
}

void trackThrough(Sequence& sequence, std::ostream& out) {
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  sequence.rewind();
  cv::Mat image;
  for (std::size_t frame = 0; sequence.next(image); ++frame) {
    if (frame == 0) {
      tracker.select(image, 0.0, sequence.roi());
      continue;
    }
    const tracking::TrackResult result = tracker.track(image, kPeriod * static_cast<double>(frame));
    Row row{"sequence", sequence.name(), frame, sequence.covered()[frame]};
    row.error = cornerError(result.g, sequence.truth()[frame], sequence.roi());
    fill(row, result);
    write(out, row);
  }
}

void fill(Row& row, const tracking::EsmResult& result, const GatedEsm& gated) {
  row.iterations = result.iterations;
  row.corner_error = result.corner_error;
  row.gain = result.state.gain;
  row.sigma = result.sigma;
  row.last_step = result.last_step;
  row.status = static_cast<int>(result.status);
  if (!GatedEsm::usable(result)) return;
  row.zncc = gated.zncc();
  row.visible_fraction = gated.visibleFraction();
}

struct Trials {
  int per_frame = 3;
  int every = 5;       // frames
  double most = 30.0;  // px
};

void perturb(Sequence& sequence, const Trials& trials, unsigned seed, std::ostream& out) {
  tracking::TrackerConfig config;
  config.quality = credulous();
  sequence.rewind();
  const geometry::Rectangle& roi = sequence.roi();
  cv::Mat first, image;
  if (!sequence.next(first)) return;
  GatedEsm gated(tracking::TrackerConfig(), first, roi);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, trials.most);
  for (std::size_t frame = 1; sequence.next(image); ++frame) {
    if (frame % static_cast<std::size_t>(trials.every) != 0) continue;
    const Eigen::Matrix3d& truth = sequence.truth()[frame];
    for (int trial = 0; trial < trials.per_frame; ++trial) {
      const double sigma = uniform(random);
      const Eigen::Matrix3d off =
          trial % 2 == 0 ? displacedCorners(roi, sigma, random) : displaced(2.0 * sigma, random);
      Row row{"esm", sequence.name(), frame, sequence.covered()[frame]};
      row.start_error = cornerError(truth * off, truth, roi);
      const tracking::EsmResult aligned = gated.align(image, truth * off);
      fill(row, aligned, gated);
      row.error = cornerError(aligned.state.g, truth, roi);
      write(out, row);

      // The tracker cannot be told where to start: the image moves instead, so that the ROI is `off` from where it was
      // first.
      const Eigen::Matrix3d shown = off.inverse() * truth.inverse();
      const cv::Mat moved = view(image, shown, 0.0, random);
      tracking::RegionTracker tracker(config);
      tracker.select(first, 0.0, roi);
      const tracking::TrackResult result = tracker.track(moved, kPeriod);
      Row jump{"jump", sequence.name(), frame, sequence.covered()[frame]};
      jump.start_error = cornerError(Eigen::Matrix3d::Identity(), shown * truth, roi);
      jump.error = cornerError(result.g, shown * truth, roi);
      fill(jump, result);
      write(out, jump);
    }
  }
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> folders;
  std::string file;
  Trials trials;
  unsigned seed = 1;
  po::options_description options("Evidence and error of many estimates, as CSV. bench_honesty [options] FOLDER...");
  options.add_options()("help", "this text")                                                                  //
      ("sequence", po::value(&folders)->composing(), "folder with frames/, truth.csv and scene.json")         //
      ("trials", po::value(&trials.per_frame)->default_value(3), "displaced starts per frame used; 0: none")  //
      ("every", po::value(&trials.every)->default_value(5), "every so many frames are used for them")         //
      ("most", po::value(&trials.most)->default_value(30.0),
       "px, largest displacement's sigma; shifts go to twice that")         //
      ("seed", po::value(&seed)->default_value(1), "of the displacements")  //
      ("csv", po::value(&file), "write there instead of to the standard output");
  po::positional_options_description positions;
  positions.add("sequence", -1);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(options).positional(positions).run(), given);
  po::notify(given);
  if (given.count("help") > 0 || folders.empty() || trials.every < 1) {
    std::cout << options;
    return given.count("help") > 0 ? 0 : 2;
  }
  std::ofstream stream;
  if (!file.empty()) {
    stream.open(file);
    if (!stream) throw std::runtime_error(file + ": cannot be written");
  }
  std::ostream& out = file.empty() ? std::cout : stream;
  writeHeader(out);
  for (const std::string& folder : folders) {
    Sequence sequence(folder);
    if (!sequence.hasTruth() || !sequence.hasRoi())
      throw std::runtime_error(folder + ": no truth.csv, or no scene.json");
    trackThrough(sequence, out);
    if (trials.per_frame > 0) perturb(sequence, trials, seed, out);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_honesty", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
