// What the tracker knows about an estimate, beside how wrong the estimate is: the data to choose the thresholds of the
// state on, and to test what it says of its own error.
//
// Rows of two sources:
//   sequence  the tracker as configured by default, image by image
//   jump      the tracker after its first images, thrown onto a later one that is displaced besides, as if the images
//             between were lost. Alignments with bad starts converge falsely: these are the wrong estimates. What is
//             known of an estimate comes from a tracker whose limits are as lax as can be set (`estimated`: it believed
//             the estimate); `accepted` is what the tracker as configured by default, shown the same images, said
// What tissue and camera are like is known from the first images: columns record_... .
#include <boost/program_options.hpp>
#include <fstream>
#include <iostream>
#include <limits>

#include "bench/support/arguments.h"
#include "bench/support/configurations.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "bench/support/synthetic.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s, between images
constexpr int kFirst = 8;         // images before the jump, after the reference

struct Row {
  std::string source;
  std::string sequence;
  std::size_t frame = 0;
  double covered = 0.0;  // truth: share of the ROI
  double error = 0.0;    // px, of the worst corner
  bool estimated = false;
  bool accepted = false;
  tracking::TrackResult result;
};

// Means over the first images.
struct Record {
  double zncc = std::numeric_limits<double>::quiet_NaN();
  double sigma = zncc;  // grey levels
};

void writeHeader(std::ostream& out) {
  out << "source,sequence,frame,covered,error,estimated,accepted,zncc,sigma,corner_error,visible_fraction,iterations,"
         "record_zncc,record_sigma\n";
}

void write(std::ostream& out, const Row& row, const Record& record) {
  const tracking::TrackResult& r = row.result;
  out << row.source << ',' << row.sequence << ',' << row.frame << ',' << row.covered << ',' << row.error << ','
      << row.estimated << ',' << row.accepted << ',' << r.zncc << ',' << r.sigma << ',' << r.corner_error << ','
      << r.visible_fraction << ',' << r.iterations << ',' << record.zncc << ',' << record.sigma << '\n';
}

bool tracks(const tracking::TrackResult& result) {
  return result.state == tracking::State::kTracking;
}

Record recordOf(const std::vector<tracking::TrackResult>& results) {
  std::vector<double> zncc, sigma;
  for (const tracking::TrackResult& result : results) {
    if (!tracks(result)) continue;
    zncc.push_back(result.zncc);
    sigma.push_back(result.sigma);
  }
  return {mean(zncc), mean(sigma)};
}

struct Trials {
  int per_frame = 3;
  int every = 5;       // frames
  double most = 30.0;  // px
};

// The first images, and what the tracker made of them.
struct Beginning {
  std::vector<cv::Mat> images;
  Record record;
  Eigen::Matrix3d last = Eigen::Matrix3d::Identity();  // truth of the last one
};

Beginning trackThrough(Sequence& sequence, std::ostream& out) {
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  Beginning beginning;
  std::vector<tracking::TrackResult> results;
  std::vector<Row> rows;
  sequence.rewind();
  cv::Mat image;
  for (std::size_t frame = 0; sequence.next(image); ++frame) {
    if (frame <= kFirst) {
      beginning.images.push_back(image.clone());
      beginning.last = sequence.truth()[frame];
    }
    if (frame == 0) {
      tracker.select(image, 0.0, sequence.roi());
      continue;
    }
    Row row{"sequence", sequence.name(), frame, sequence.covered()[frame], 0.0, false, false, {}};
    row.result = tracker.track(image, kPeriod * static_cast<double>(frame));
    row.error = cornerError(row.result.g, sequence.truth()[frame], sequence.roi());
    row.estimated = row.accepted = tracks(row.result);
    if (frame <= kFirst) results.push_back(row.result);
    rows.push_back(std::move(row));
  }
  beginning.record = recordOf(results);
  for (const Row& row : rows) write(out, row, beginning.record);
  return beginning;
}

tracking::TrackResult thrown(const tracking::TrackerConfig& config, const Beginning& beginning,
                             const geometry::Rectangle& roi, std::size_t shown, const cv::Mat& image) {
  tracking::RegionTracker tracker(config);
  tracker.select(beginning.images[0], 0.0, roi);
  for (std::size_t k = 1; k < shown; ++k) tracker.track(beginning.images[k], kPeriod * static_cast<double>(k));
  return tracker.track(image, kPeriod * static_cast<double>(shown));
}

void jump(Sequence& sequence, const Beginning& beginning, const Trials& trials, unsigned seed, std::ostream& out) {
  tracking::TrackerConfig lax;
  lax.quality = credulous();
  const geometry::Rectangle& roi = sequence.roi();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, trials.most);
  sequence.rewind();
  cv::Mat image;
  for (std::size_t frame = 0; sequence.next(image); ++frame) {
    if (frame <= kFirst || frame % static_cast<std::size_t>(trials.every) != 0) continue;
    for (int trial = 0; trial < trials.per_frame; ++trial) {
      const double sigma = uniform(random);
      const Eigen::Matrix3d off =
          trial % 2 == 0 ? displacedCorners(roi, sigma, random) : displaced(2.0 * sigma, random);
      // The tracker cannot be told where to start: the image moves instead, so that the ROI is `off` from where it was.
      const Eigen::Matrix3d from_first = off * sequence.truth()[frame].inverse();
      const Eigen::Matrix3d from_last = beginning.last * from_first;
      Row row{"jump", sequence.name(), frame, sequence.covered()[frame], 0.0, false, false, {}};
      // The lax tracker compares with its own record of the ROI, which no limit turns off: it is given none.
      row.result = thrown(lax, beginning, roi, 1, view(image, from_first, 0.0, random));
      row.estimated = tracks(row.result);
      row.error = cornerError(row.result.g, off, roi);
      const tracking::TrackResult strict = thrown(tracking::TrackerConfig(), beginning, roi, beginning.images.size(),
                                                  view(image, from_last, 0.0, random));
      row.accepted = tracks(strict);
      write(out, row, beginning.record);
      if (!row.accepted) continue;
      Row said{"accepted", sequence.name(), frame, sequence.covered()[frame], 0.0, false, false, {}};
      said.result = strict;
      said.estimated = said.accepted = true;
      said.error = cornerError(strict.g, beginning.last * off, roi);
      write(out, said, beginning.record);
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
    const Beginning beginning = trackThrough(sequence, out);
    if (trials.per_frame > 0) jump(sequence, beginning, trials, seed, out);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_honesty", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
