// This package's tracker beside its peers, over the same images in one run, on one thread. All contestants get each
// image before any gets the next, in an order that turns by one each time, so that what disturbs the machine disturbs
// all alike. Ratios are of processor time, which equals wall time on a machine that does nothing else.
#include <algorithm>
#include <boost/program_options.hpp>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>

#include "bench/support/arguments.h"
#include "bench/support/contestant.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "ros/common/json_writer.h"

namespace laparoscope_servo::bench {

namespace {

struct Record {
  std::string name;
  std::vector<double> error;   // px, per frame of the first pass
  std::vector<double> claims;  // 1 or 0, likewise
  std::vector<double> ms;      // wall time of every frame of every pass, but for the reference and when it had stopped
  std::vector<double> cpu_ms;  // processor time likewise
  std::vector<double> g;  // row by row, of every frame of the first pass: what the field publishes is computed of it
};

struct Summary {
  double error_mean = std::numeric_limits<double>::quiet_NaN();  // px, of the frames kept
  double error_p95 = error_mean;
  double kept = 0.0;  // frames claimed with an error under kLost
  double lies = 0.0;  // frames claimed with kLost or more
  double silent = 0.0;
  double ms_median = error_mean;
  double ms_p99 = error_mean;
  double cpu_ms_median = error_mean;
};

Summary summarise(const Record& record) {
  Summary s;
  std::vector<double> good;
  for (std::size_t k = 0; k < record.error.size(); ++k) {
    const bool claims = record.claims[k] > 0.0;
    const bool right = record.error[k] < kLost;
    if (claims && right) good.push_back(record.error[k]);
    s.lies += claims && !right ? 1.0 : 0.0;
    s.silent += claims ? 0.0 : 1.0;
  }
  s.kept = static_cast<double>(good.size());
  s.error_mean = mean(good);
  s.error_p95 = quantile(good, 0.95);
  s.ms_median = quantile(record.ms, 0.5);
  s.ms_p99 = quantile(record.ms, 0.99);
  s.cpu_ms_median = quantile(record.cpu_ms, 0.5);
  return s;
}

// False when it does not want this ROI; why is printed, and the others go on.
bool selects(Contestant& contestant, const cv::Mat& image, const geometry::Rectangle& roi) {
  try {
    contestant.select(image, roi);
    return true;
  } catch (const std::exception& error) {
    std::cerr << contestant.name() << " refuses the ROI: " << error.what() << '\n';
    return false;
  }
}

std::vector<Record> compare(Sequence& sequence, const std::vector<std::string>& names, int passes) {
  std::vector<std::unique_ptr<Contestant>> contestants = makeContestants(names);
  std::vector<Record> records;
  for (const auto& contestant : contestants) records.emplace_back().name = contestant->name();
  std::vector<char> refused(contestants.size(), 0);
  for (int pass = 0; pass < passes; ++pass) {
    sequence.rewind();
    cv::Mat image;
    for (std::size_t frame = 0; sequence.next(image); ++frame) {
      for (std::size_t k = 0; k < contestants.size(); ++k) {
        const std::size_t turn = (k + frame) % contestants.size();
        Record& record = records[turn];
        Verdict verdict;
        verdict.claims = true;
        if (frame == 0) {
          refused[turn] = !selects(*contestants[turn], image, sequence.roi());
          verdict.claims = !refused[turn];
        } else if (refused[turn]) {
          verdict = {Eigen::Matrix3d::Identity(), false, true};
        } else {
          const auto start = std::chrono::steady_clock::now();
          const double cpu_start = cpuTime();
          verdict = contestants[turn]->track(image);
          const double cpu_ms = 1e3 * (cpuTime() - cpu_start);
          const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
          if (!verdict.idle) {
            record.cpu_ms.push_back(cpu_ms);
            record.ms.push_back(wall.count());
          }
        }
        if (pass > 0) continue;
        record.claims.push_back(verdict.claims ? 1.0 : 0.0);
        record.error.push_back(cornerError(verdict.g, sequence.truth().at(frame), sequence.roi()));
        for (int cell = 0; cell < 9; ++cell) record.g.push_back(verdict.g(cell / 3, cell % 3));
      }
      image.release();  // some keep it
    }
  }
  return records;
}

void print(const std::string& name, std::size_t frames, const std::vector<Record>& records) {
  std::cout << name << ", " << frames << " frames\n"
            << "  tracker        error mean  p95 [px]  kept  lies  silent  median       p99  cpu [ms]  time / "
            << records[0].name << '\n';
  const double ours = summarise(records[0]).cpu_ms_median;
  for (const Record& record : records) {
    const Summary s = summarise(record);
    std::cout << "  " << std::left << std::setw(14) << record.name << std::right << std::fixed << std::setprecision(3)
              << std::setw(11) << s.error_mean << std::setw(10) << s.error_p95 << std::setprecision(0) << std::setw(6)
              << s.kept << std::setw(6) << s.lies << std::setw(8) << s.silent << std::setprecision(3) << std::setw(8)
              << s.ms_median << std::setw(10) << s.ms_p99 << std::setw(10) << s.cpu_ms_median << std::setprecision(2)
              << std::setw(10) << s.cpu_ms_median / ours << '\n';
  }
  std::cout << std::flush;
}

void write(JsonWriter& json, const Sequence& sequence, const std::vector<Record>& records) {
  json.beginObject();
  json.value("sequence", sequence.name());
  json.value("frames", static_cast<double>(sequence.truth().size()));
  json.values("covered", sequence.covered());
  json.beginArray("trackers");
  const double ours = summarise(records[0]).cpu_ms_median;
  for (const Record& record : records) {
    const Summary s = summarise(record);
    json.beginObject();
    json.value("name", record.name);
    json.value("error_mean", s.error_mean);
    json.value("error_p95", s.error_p95);
    json.value("kept", s.kept);
    json.value("lies", s.lies);
    json.value("silent", s.silent);
    json.value("ms_median", s.ms_median);
    json.value("ms_p99", s.ms_p99);
    json.value("cpu_ms_median", s.cpu_ms_median);
    json.value("time_ratio", s.cpu_ms_median / ours);
    json.values("error", record.error);
    json.values("claims", record.claims);
    json.values("g", record.g);
    json.values("ms", record.ms);
    json.values("cpu_ms", record.cpu_ms);
    json.end();
  }
  json.end();
  json.end();
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> folders, trackers;
  std::string file;
  int passes = 1;
  po::options_description options(
      "Compares trackers over sequences with ground truth. bench_compare [options] FOLDER...");
  options.add_options()("help", "this text")                                                           //
      ("sequence", po::value(&folders)->composing(), "folder with frames/, truth.csv and scene.json")  //
      ("tracker", po::value(&trackers)->composing(),
       "only this one, may be repeated; the first is the reference of the ratios; ours_luma, ours_strongest and "
       "ours_colour take part only so")                                                      //
      ("passes", po::value(&passes)->default_value(1), "over each sequence, for the times")  //
      ("json", po::value(&file), "write everything there");
  const auto complete = [&] { return !folders.empty() && passes >= 1; };
  if (const auto status = parse(argc, argv, options, "sequence", -1, complete)) return *status;
  std::ofstream stream = create(file);
  JsonWriter json(stream);
  json.beginArray();
  for (const std::string& folder : folders) {
    Sequence sequence(folder);
    if (!sequence.hasTruth() || !sequence.hasRoi())
      throw std::runtime_error(folder + ": no truth.csv, or no scene.json");
    if (sequence.areas().empty() && *std::max_element(sequence.covered().begin(), sequence.covered().end()) > 0.0)
      throw std::runtime_error(folder + ": something covers the region, and there is no areas.csv to say where");
    const std::vector<Record> records = compare(sequence, trackers, passes);
    print(sequence.name(), sequence.truth().size(), records);
    write(json, sequence, records);
  }
  json.end();
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_compare", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
