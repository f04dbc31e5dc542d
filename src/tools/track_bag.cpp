// Tracks through a bag, a video or a folder of images without a master: see --help.
#include <unistd.h>

#include <algorithm>
#include <boost/process.hpp>
#include <boost/program_options.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "ros/common/run_tool.h"
#include "ros/features/feature_trackers.h"
#include "ros/features/selection_text.h"
#include "ros/playback/feature_offline.h"
#include "ros/playback/offline_options.h"
#include "ros/playback/tracker_offline.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

constexpr int kSignalled = 128;  // plus the signal's number, as in shells

struct Command {
  OfflineOptions offline;
  std::string tracker = "region";
  std::string roi;
  bool draw = false;              // --select of the region tracker
  std::optional<int> late_masks;  // --instruments of the region tracker
  std::string selection;          // --select FILE of the others
  std::string parameters;
};

// What --select means depends on the tracker: a region is drawn, features stand in a file.
bool namesFeatures(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--tracker") return k + 1 < argc && argv[k + 1] != std::string("region");
    if (argument.rfind("--tracker=", 0) == 0) return argument != "--tracker=region";
  }
  return false;
}

options::options_description describeOptions(Command& command, bool features) {
  std::string names = "region";
  for (const std::string& name : featureTrackers()) names += ", " + name;
  options::options_description description("Options");
  auto add = description.add_options();
  add("help", "print this and end");
  add("tracker", options::value(&command.tracker),
      (names + ": what is tracked, a region unless said otherwise").c_str());
  if (features) {
    add("select", options::value(&command.selection), "file with the features in the first image, see doc/features.md");
  } else {
    add("roi", options::value(&command.roi), "x,y,width,height: region in the first image, px");
    add("select", options::bool_switch(&command.draw),
        "the region is drawn in a window that shows the first image; with another tracker --select FILE.yaml: the file "
        "with the features");
    add("resume", options::value(&command.offline.source.resume),
        "s of the input: after the first image, in which the region is selected, those before this time are skipped, "
        "and "
        "the region is searched for from there on");
    add("instruments", options::value<int>()->implicit_value(0)->notifier([&](int late) { command.late_masks = late; }),
        "instruments are found, too, and the region tracker is told what they cover; =N: N images late, as between "
        "nodes, 0 unless said otherwise");
  }
  describeInput(description, command.offline, command.parameters);
  add("csv", options::value(&command.offline.csv), "table to write, a line per image, or per image and feature");
  add("output", options::value(&command.offline.bag),
      "bag to write: homography, task_error, areas, roi under /tracker, or features under the tracker's name");
  add("overlay", options::value(&command.offline.overlay),
      "video to write (.mp4, .avi): the images with ROI and occluded areas, or with the features");
  return description;
}

// By the program that has a window: this one needs no display, nor its libraries.
std::string drawnRegion(const OfflineOptions& offline, const std::string& parameters) {
  namespace process = boost::process;
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "select_region";
  if (!std::filesystem::exists(program)) throw std::runtime_error("'" + program.string() + "' is not there");
  process::ipstream output;
  process::child window(program.string(), process::args(inputArguments(offline, parameters)),
                        process::std_out > output);
  std::string region;
  std::getline(output, region);
  window.wait();
  if (region.empty() || window.exit_code() != EXIT_SUCCESS) throw std::runtime_error("--select gave no region");
  std::cerr << "region: --roi " << region << '\n';
  return region;
}

// Shows position, rate, time left and state: on a terminal in one changing line, in a log in a new line now and then.
class ProgressLine {
 public:
  void operator()(const OfflineSummary& summary, std::size_t expected) {
    const auto state =
        std::mismatch(summary.by_state.begin(), summary.by_state.end(), by_state_.begin(), by_state_.end());
    if (state.first != summary.by_state.end())
      state_ = static_cast<std::size_t>(state.first - summary.by_state.begin());
    by_state_ = summary.by_state;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10))) return;
    last_ = now;
    const double rate = static_cast<double>(summary.images) / std::chrono::duration<double>(now - begin_).count();
    std::fprintf(stderr, "%simage %zu", terminal_ ? "\r" : "", summary.images);
    if (expected > 0) std::fprintf(stderr, " of %zu", expected);
    std::fprintf(stderr, ", %.1f images/s", rate);
    if (expected > summary.images)
      std::fprintf(stderr, ", %.0f s left", static_cast<double>(expected - summary.images) / rate);
    std::fprintf(stderr, ", %s%s", tracking::stateName(static_cast<tracking::State>(state_)),
                 terminal_ ? "\033[K" : "\n");
    shown_ = terminal_;
  }
  void end() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
  std::vector<std::size_t> by_state_;  // of the last summary; the count that has grown is that of the present state
  std::size_t state_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = begin_;
};

void printSummary(const OfflineSummary& summary) {
  std::fprintf(stderr, "%zu images:", summary.images);
  for (std::size_t state = 0; state < summary.by_state.size(); ++state) {
    const char* name = laparoscope_servo::tracking::stateName(static_cast<laparoscope_servo::tracking::State>(state));
    if (summary.by_state[state] > 0) std::fprintf(stderr, " %s %zu", name, summary.by_state[state]);
  }
  std::vector<double> times = summary.times;
  const double median = laparoscope_servo::robust::median(times);
  std::fprintf(stderr, "; time per image: median %.2f ms, 99 %% below %.2f ms\n", 1e3 * median,
               1e3 * laparoscope_servo::robust::nearestRank(times, 0.99));
}

// Beside what the tracker had said when the bag was recorded.
void printRecorded(const OfflineSummary& summary) {
  if (summary.apart.empty() && summary.other_state == 0) return;
  std::vector<double> apart = summary.apart;
  std::fprintf(stderr, "recorded results: in %zu images both tracked, in %zu only one did", apart.size(),
               summary.other_state);
  if (!apart.empty()) {
    const double median = robust::median(apart);
    std::fprintf(stderr, "; the worst corner is %.2f px apart (median), 99 %% below %.2f px, the most %.2f px", median,
                 robust::nearestRank(apart, 0.99), *std::max_element(apart.begin(), apart.end()));
  }
  std::fputc('\n', stderr);
}

volatile std::sig_atomic_t stop_signal = 0;

void onSignal(int signal) {
  stop_signal = signal;
  std::signal(signal, SIG_DFL);  // a second one ends it at once
}

void catchSignals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onSignal);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the file size is then reported like a full disk
}

int exitStatus(const OfflineSummary& summary) {
  if (!summary.source_error.empty()) std::cerr << "track_bag: " << summary.source_error << '\n';
  if (summary.refused > 0) {
    std::cerr << summary.refused << " of " << summary.refused + summary.images << " images could not be processed\n";
  }
  if (summary.stopped) {
    std::cerr << "track_bag: ended by " << strsignal(stop_signal) << " after " << summary.images << " images, "
              << (summary.images > 0 ? "the outputs hold them" : "nothing is written") << '\n';
    return kSignalled + stop_signal;
  }
  return summary.refused == 0 && summary.source_error.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
}

// `track`: trackOffline or trackFeaturesOffline, with its options.
int run(const std::function<OfflineSummary(const OfflineProgress&, const OfflineReport&)>& track) {
  ProgressLine line;
  catchSignals();
  const OfflineSummary summary =
      track([&line](const OfflineSummary& so_far, std::size_t expected) { line(so_far, expected); },
            [&line](std::size_t frame, const std::string& error) {
              line.end();
              std::cerr << "image " << frame << " is left out: " << error << '\n';
            });
  line.end();
  for (const std::string& note : summary.notes) std::cerr << "note: " << note << '\n';
  if (summary.images > 0) printSummary(summary);
  printRecorded(summary);
  return exitStatus(summary);
}

int runRegion(Command& command) {
  OfflineOptions& offline = command.offline;
  offline.parameters = readOfflineParameters(command.parameters);
  if (command.draw && !command.roi.empty())
    throw std::invalid_argument("both --select and --roi are given, expected one of them");
  if (command.draw) command.roi = drawnRegion(offline, command.parameters);
  if (!command.roi.empty()) offline.parameters.roi = parseRoi(command.roi);
  if (!offline.parameters.roi)
    throw std::invalid_argument("no ROI is given, expected --roi x,y,width,height in px, or --select");
  if (command.late_masks)
    offline.instruments = readInstrumentMaskOptions(*command.late_masks, offline.parameters.external_mask.max_age);
  return run([&](const OfflineProgress& progress, const OfflineReport& report) {
    return trackOffline(offline, progress, report);
  });
}

int runFeatures(const Command& command) {
  FeatureOfflineOptions features{command.offline, command.tracker, command.parameters, {}};
  if (!command.selection.empty()) features.selection = readSelection(command.selection);
  return run([&](const OfflineProgress& progress, const OfflineReport& report) {
    return trackFeaturesOffline(features, progress, report);
  });
}

}  // namespace

int main(int argc, char** argv) {
  Command command;
  const bool features = namesFeatures(argc, argv);
  const options::options_description description = describeOptions(command, features);
  const std::string usage =
      "track_bag INPUT... --roi x,y,w,h|--select [options]: tracks a region through recorded images.\n"
      "track_bag INPUT... --tracker NAME --select FILE.yaml [options]: tracks features.\n"
      "Ends with status 0 when every image was processed, whatever the tracker found; with 1 when images\n"
      "are lost or damaged (each is named) or an output cannot be written. Outputs appear under their\n"
      "names when they are whole. A signal ends the work as the input's end would, with status 128 and its\n"
      "number.\n";
  return runTool(argc, argv, "track_bag", usage, description, "input", [&] {
    if (command.offline.inputs.empty())
      throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
    command.offline.stopped = [] { return stop_signal != 0; };
    return features ? runFeatures(command) : runRegion(command);
  });
}
