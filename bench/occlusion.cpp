// One tracker over one input, with all that is known of its areas, as a table: the numbers behind the paper's figures 3
// to 5.
//
// Configurations: `none` is ESM as it was before Bourger et al. (2007); `published` adds the detection of occlusions as
// they published it (eq. (1) to (5), 32 bins, tau_b = 0.5). Both follow every estimate, since the paper has no test of
// it. `default` is this package's.
#include <algorithm>
#include <boost/program_options.hpp>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "bench/support/arguments.h"
#include "bench/support/configurations.h"
#include "bench/support/sequence.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;  // s, between images

void writeHeader(std::ostream& out, int areas) {
  out << "frame,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,corner_error,iterations,occluded";
  for (int k = 0; k < areas; ++k) out << ",o" << k;
  for (int k = 0; k < areas; ++k) out << ",d" << k;
  out << '\n';
}

void writeLine(std::ostream& out, int frame, const tracking::TrackResult& result) {
  out << frame << ',' << static_cast<int>(result.state);
  for (int k = 0; k < 9; ++k) out << ',' << result.g(k / 3, k % 3);
  int occluded = 0;
  for (const bool o : result.areas.occluded) occluded += o ? 1 : 0;
  out << ',' << result.visible_fraction << ',' << result.zncc << ',' << result.corner_error << ',' << result.iterations
      << ',' << occluded;
  for (const bool o : result.areas.occluded) out << ',' << (o ? 1 : 0);
  out.precision(5);
  for (const float distance : result.areas.distance) out << ',' << distance;
  out.precision(12);
  out << '\n';
}

// The paper's tracker: every image starts where the last one ended, with nothing else known from it, and what comes out
// is the estimate.
class PapersTracker {
 public:
  PapersTracker(const tracking::TrackerConfig& config, const cv::Mat& image, const geometry::Rectangle& roi)
      : aligner_(config) {
    aligner_.setReference(image, roi);
  }

  tracking::TrackResult track(const cv::Mat& image) {
    tracking::EsmState start;
    start.g = g_;
    aligner_.startAfresh();
    const tracking::Alignment found = aligner_.align(image, start, nullptr, std::max(image.cols, image.rows));
    const bool usable = (found.esm.status == tracking::EsmStatus::kConverged ||
                         found.esm.status == tracking::EsmStatus::kMaxIterations) &&
                        found.esm.state.g.allFinite();
    if (usable) g_ = found.esm.state.g;
    tracking::TrackResult result;
    result.state = usable ? tracking::State::kTracking : tracking::State::kLost;
    result.g = g_;
    result.corner_error = found.esm.corner_error;
    result.iterations = found.esm.iterations;
    result.visible_fraction = found.visible_fraction;
    result.zncc = found.zncc;
    const tracking::OcclusionGates& gates = aligner_.gates();
    result.areas = {gates.grid().rows(), gates.grid().columns(), gates.distances(), {}, {}};
    for (int k = 0; k < gates.grid().count(); ++k) result.areas.occluded.push_back(gates.occluded(k));
    return result;
  }

 private:
  tracking::RegionAligner aligner_;
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity();
};

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string input, file, roi_text, configuration;
  po::options_description options("bench_occlusion [options] FOLDER_OR_VIDEO");
  options.add_options()("help", "this text")                                                           //
      ("input", po::value(&input), "folder of a sequence, folder of images, or video")                 //
      ("roi", po::value(&roi_text), "x,y,width,height in the first image; by default the sequence's")  //
      ("config", po::value(&configuration)->default_value("default"), "none, published or default")    //
      ("csv", po::value(&file), "write there instead of to the standard output");
  const auto complete = [&] { return !input.empty(); };
  if (const auto status = parse(argc, argv, options, "input", 1, complete)) return *status;
  Sequence sequence(input);
  if (roi_text.empty() && !sequence.hasRoi())
    throw std::invalid_argument("no scene.json beside the images: --roi is needed");
  const geometry::Rectangle roi = roi_text.empty() ? sequence.roi() : parseRoi(roi_text);
  tracking::RegionTracker tracker(configurationNamed(configuration));

  std::ofstream stream = create(file);
  std::ostream& out = file.empty() ? std::cout : stream;
  out.precision(12);
  std::unique_ptr<PapersTracker> papers;
  cv::Mat image;
  for (int frame = 0; sequence.next(image); ++frame) {
    tracking::TrackResult result;
    if (configuration == "default") {
      result = frame == 0 ? tracker.select(image, 0.0, roi) : tracker.track(image, kPeriod * frame);
    } else {
      if (frame == 0) papers = std::make_unique<PapersTracker>(tracker.config(), image, roi);
      result = papers->track(image);
    }
    if (frame == 0) writeHeader(out, result.areas.rows * result.areas.columns);
    writeLine(out, frame, result);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_occlusion",
                                       [&] { return laparoscope_servo::bench::program(argc, argv); });
}
