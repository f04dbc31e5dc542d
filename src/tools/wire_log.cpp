// Prints a recording of the serial line, or runs it through the driver again: see --help.
#include <ros/package.h>

#include <boost/program_options.hpp>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>

#include "laparoscope_servo/aesop/wire_printer.h"
#include "laparoscope_servo/aesop/wire_replay.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/common/run_tool.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

struct Arguments {
  std::vector<std::string> files;
  std::vector<std::string> params;
  std::string codec;
  bool replay = false;
  bool summary = false;
};

options::options_description describeOptions(Arguments& arguments) {
  options::options_description description("Options");
  auto add = description.add_options();
  add("help,h", "print this and end");
  add("file", options::value(&arguments.files)->composing(), "recordings, the oldest first, e.g. wire.log.1 wire.log");
  add("replay", options::bool_switch(&arguments.replay),
      "run the recording through the driver: prints its states, then where it does otherwise than recorded");
  add("params", options::value(&arguments.params)->composing(),
      "YAML file laid over the package's config/aesop.yaml, for --replay; may be given several times");
  add("summary", options::bool_switch(&arguments.summary), "only what it comes to");
  add("codec", options::value(&arguments.codec)->default_value(aesop::codecNames().front()), "name of the wire format");
  return description;
}

std::string utc(std::int64_t microseconds) {
  const auto seconds = static_cast<std::time_t>(microseconds / 1000000);
  std::tm parts{};
  char text[64] = "";
  if (gmtime_r(&seconds, &parts) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

// Reads all records of the files in order, with the time of the first. Prints the errors of each file at its end.
bool readAll(const Arguments& arguments, const std::function<void(const aesop::WireRecord&, std::int64_t)>& use) {
  bool good = true;
  std::int64_t start = 0;
  bool started = false;
  for (const std::string& name : arguments.files) {
    std::ifstream file(name, std::ios::binary);
    if (!file) throw std::runtime_error("'" + name + "' cannot be read");
    try {
      aesop::WireLogReader reader(file);
      std::cout << "# " << name << ", begun " << utc(reader.header().wall_time) << ", format " << reader.header().codec
                << '\n';
      if (!started) start = reader.header().time;
      started = true;
      while (const auto record = reader.next()) use(*record, start);
      if (reader.truncated()) std::cerr << "wire_log: '" << name << "' breaks off within a record\n";
    } catch (const aesop::WireLogError& error) {
      std::cerr << "wire_log: '" << name << "': " << error.what() << '\n';
      good = false;
    }
  }
  return good;
}

aesop::DriverConfig readConfig(const Arguments& arguments) {
  XmlRpc::XmlRpcValue tree = parametersFromYaml(ros::package::getPath("laparoscope_servo") + "/config/aesop.yaml");
  for (const std::string& file : arguments.params) tree = mergeParameters(tree, parametersFromYaml(file));
  if (!tree.hasMember("port")) tree["port"] = std::string("none");
  ParameterReader reader(tree, "params");
  aesop::DriverConfig config = readAesopParameters(reader).driver;
  if (!reader.errors().empty()) throw std::runtime_error(reader.report());
  config.session.codec = aesop::codecNamed(arguments.codec);
  return config;
}

int print(const Arguments& arguments) {
  aesop::WirePrinter printer(aesop::codecNamed(arguments.codec));
  std::ostream nowhere(nullptr);
  const bool good = readAll(arguments, [&](const aesop::WireRecord& record, std::int64_t start) {
    printer.print(record, start, arguments.summary ? nowhere : std::cout);
  });
  printer.printSummary(std::cout);
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

void printState(double time, const aesop::OperatingState& state) {
  std::cout << std::fixed << std::setprecision(6) << std::setw(13) << time << ' ' << aesop::name(state.mode)
            << (state.is_homed ? " homed" : "") << (state.is_busy ? " busy" : "") << (state.reason.empty() ? "" : ": ")
            << state.reason << '\n';
}

void printStatistics(const aesop::WireReplay& replay, std::int64_t start) {
  const aesop::LinkStatistics& link = replay.driver().session().link().statistics();
  const aesop::ReplayStatistics& statistics = replay.statistics();
  std::cout << std::defaultfloat << "sessions " << link.sessions << ", requests " << link.sent << ", statuses "
            << link.received << ", replies lost " << link.lost << ", CRC errors " << link.decoder.crc_errors
            << ", malformed " << link.decoder.malformed << ", bytes skipped " << link.decoder.skipped_bytes << '\n'
            << statistics.turns << " turns; other bytes than recorded in " << statistics.other_bytes
            << ", another state after " << statistics.other_states << '\n';
  if (statistics.first_other) {
    std::cout << "the first at " << *statistics.first_other - 1e-9 * static_cast<double>(start)
              << " s: another version of the driver, or other --params than then\n";
  }
}

int replay(const Arguments& arguments) {
  aesop::WireReplay replay(readConfig(arguments));
  aesop::OperatingState last;
  bool any = false;
  std::int64_t begun = 0;
  const bool good = readAll(arguments, [&](const aesop::WireRecord& record, std::int64_t start) {
    begun = start;
    replay.feed(record);
    const aesop::OperatingState state = replay.state();
    if (any && state == last) return;
    any = true;
    last = state;
    if (!arguments.summary) printState(1e-9 * static_cast<double>(record.time - start), state);
  });
  replay.end();
  printStatistics(replay, begun);
  return good && !replay.statistics().first_other ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  const options::options_description description = describeOptions(arguments);
  const std::string usage =
      "wire_log FILE... [options]: prints what the aesop node recorded of its serial line (wire_log/file).\n"
      "> to the controller, < from it, * what the node was told; time in s, SI units, rad.\n"
      "Ends with status 1 when a file is damaged, or when --replay does otherwise than recorded.\n";
  return runTool(argc, argv, "wire_log", usage, description, "file", [&] {
    if (arguments.files.empty()) throw options::error("no recording is given");
    const int status = arguments.replay ? replay(arguments) : print(arguments);
    if (!std::cout.flush()) throw std::runtime_error("not everything could be written, is the disk full?");
    return status;
  });
}
