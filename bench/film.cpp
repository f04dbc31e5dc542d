// This package's tracker and its peers over a region of a film, whose truth is not known: a table for each tracker, in
// the columns that whoever judges them needs. As in bench_compare all get each image in turn, on one thread.
#include <boost/program_options.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>

#include "bench/support/arguments.h"
#include "bench/support/contestant.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/sequence.h"

namespace laparoscope_servo::bench {

namespace {

struct Runner {
  std::unique_ptr<Contestant> contestant;
  std::ofstream table;
  bool refused = false;
};

void writeRow(std::ostream& table, int frame, double stamp, const Verdict& verdict, double seconds) {
  table << frame << ',' << stamp << ',' << (verdict.claims ? 1 : 3);
  for (int k = 0; k < 9; ++k) table << ',' << verdict.g(k / 3, k % 3);
  table << ',' << verdict.visible_fraction << ',' << verdict.iterations << ',' << seconds << ',' << verdict.corner_error
        << ',' << verdict.centre_error << '\n';
}

// A tracker that does not want the region has a table that claims nothing.
Verdict select(Runner& runner, const cv::Mat& image, const geometry::Rectangle& roi) {
  Verdict verdict;
  try {
    runner.contestant->select(image, roi);
    verdict.claims = true;
  } catch (const std::exception& error) {
    std::cerr << runner.contestant->name() << " refuses the ROI: " << error.what() << '\n';
    runner.refused = true;
  }
  return verdict;
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string film, roi, folder;
  std::vector<std::string> trackers;
  int from = 0, limit = 0;
  double rate = 25.0;
  po::options_description options("Trackers over a region of a film. bench_film [options] FILM");
  options.add_options()("help", "this text")                                                                       //
      ("film", po::value(&film), "video, or folder of images")                                                     //
      ("roi", po::value(&roi), "x,y,w,h in its first image, or in that of --from")                                 //
      ("from", po::value(&from)->default_value(0), "image, counted from 0")                                        //
      ("limit", po::value(&limit)->default_value(0), "so many images, 0: all")                                     //
      ("rate", po::value(&rate)->default_value(25.0), "images per second")                                         //
      ("tracker", po::value(&trackers)->composing(), "only this one, may be repeated; names as in bench_compare")  //
      ("tables", po::value(&folder),
       "folder for TRACKER.csv: frame, stamp, state (1: it claims, 3: not), g00..g22, "
       "visible_fraction, iterations, processing_time (of the thread, s; nan: it has stopped for good), corner_error, "
       "centre_error");
  const auto complete = [&] { return !film.empty() && !roi.empty() && !folder.empty() && from >= 0 && rate > 0.0; };
  if (const auto status = parse(argc, argv, options, "film", 1, complete)) return *status;
  const geometry::Rectangle region = parseRoi(roi);
  std::filesystem::create_directories(folder);
  std::vector<Runner> runners;
  for (auto& contestant : makeContestants(trackers, 1.0 / rate)) {
    const std::string name = contestant->name();
    Runner& runner = runners.emplace_back();
    runner.contestant = std::move(contestant);
    runner.table = create(folder + "/" + name + ".csv");
    runner.table.precision(17);
    runner.table << "frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,iterations,processing_time,"
                    "corner_error,centre_error\n";
  }
  Sequence images(film);
  cv::Mat image;
  for (int frame = 0; (limit == 0 || frame < from + limit) && images.next(image); ++frame) {
    for (std::size_t k = 0; frame >= from && k < runners.size(); ++k) {
      Runner& runner = runners[(k + static_cast<std::size_t>(frame)) % runners.size()];
      const double start = cpuTime();
      Verdict verdict;
      verdict.idle = runner.refused;
      if (frame == from) {
        verdict = select(runner, image, region);
      } else if (!runner.refused) {
        verdict = runner.contestant->track(image);
      }
      const double seconds = verdict.idle ? std::numeric_limits<double>::quiet_NaN() : cpuTime() - start;
      writeRow(runner.table, frame, frame / rate, verdict, seconds);
    }
    image.release();  // some keep it
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_film", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
