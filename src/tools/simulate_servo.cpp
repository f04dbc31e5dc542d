// simulate_servo: the closed loop without ROS, see laparoscope_servo/closed_loop/servo_simulation.h; many runs of it,
// servo_runs.h.
#include <boost/program_options.hpp>
#include <functional>
#include <iostream>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "ros/common/output_file.h"
#include "ros/controller/controller_parameters.h"
#include "ros/simulation/servo_simulation_config.h"

namespace options = boost::program_options;
using namespace laparoscope_servo;

namespace {

void print(const closed_loop::SimulationSummary& summary) {
  if (summary.settling_time < 0.0) {
    std::cout << "not settled to 2 px and 2 % of scale\n";
  } else {
    std::cout << "settled to 2 px and 2 % of scale after " << summary.settling_time << " s\n";
  }
  std::cout << "last quarter: " << summary.final_offset << " px rms, " << 100.0 * summary.final_scale_error
            << " % of scale rms, " << summary.final_alpha * 180.0 / M_PI << " deg of spin rms, moving "
            << 100.0 * summary.moving_share << " % of the time\n"
            << "at the insertion point: lateral speed at most " << summary.max_lateral_speed
            << " m/s, lateral offset at most " << summary.max_lateral_offset << " m\n";
}

struct Request {
  unsigned seed = 1;
  int runs = 1;
  double duration = 0.0;  // s
  closed_loop::RunBounds bounds;
  std::string csv;      // empty: none
  std::string summary;  // empty: none
};

double positive(const options::variables_map& values, const std::string& name, ParameterReader& reader) {
  const double value = values[name].as<double>();
  if (!(value > 0.0 && value <= 1e6)) {
    reader.addError("--" + name + " = " + std::to_string(value) + ", expected a number above 0, at most 1e6");
  }
  return value;
}

// Errors go to the reader.
Request requestFrom(const options::variables_map& values, const closed_loop::SimulationConfig& simulation,
                    ParameterReader& reader) {
  Request request;
  request.seed = values["seed"].as<unsigned>();
  request.runs = values["runs"].as<int>();
  if (!(request.runs >= 1 && request.runs <= 100000)) {
    reader.addError("--runs = " + std::to_string(request.runs) + ", expected 1 to 100000");
  }
  request.duration = values.count("duration") > 0 ? values["duration"].as<double>() : simulation.duration;
  if (!(request.duration > 0.0 && request.duration <= 36000.0)) {
    reader.addError("--duration = " + std::to_string(request.duration) +
                    ", expected a number above 0, at most 36000 s");
  }
  request.bounds.centre = positive(values, "settled-px", reader);
  request.bounds.scale = 0.01 * positive(values, "settled-scale", reader);
  request.bounds.orientation = M_PI / 180.0 * positive(values, "settled-degrees", reader);
  request.bounds.rest_after = simulation.rest_from * request.duration;
  if (values.count("rest-after") > 0) request.bounds.rest_after = values["rest-after"].as<double>();
  if (!(request.bounds.rest_after >= 0.0 && request.bounds.rest_after < request.duration)) {
    reader.addError("--rest-after = " + std::to_string(request.bounds.rest_after) +
                    ", expected 0 s to less than the duration");
  }
  if (values.count("csv") > 0) request.csv = values["csv"].as<std::string>();
  if (values.count("summary") > 0) request.summary = values["summary"].as<std::string>();
  if (request.csv.empty() && request.summary.empty())
    reader.addError("neither --csv nor --summary, expected one of them");
  return request;
}

void runAll(const Request& request, const closed_loop::ControllerSetup& controller,
            const closed_loop::SimulationConfig& simulation) {
  std::vector<closed_loop::RunSummary> runs;
  for (int k = 0; k < request.runs; ++k) {
    const unsigned seed = request.seed + static_cast<unsigned>(k);
    const closed_loop::DrawnStart drawn = closed_loop::drawStart(simulation, seed);
    closed_loop::SimulationConfig started = simulation;
    started.start = drawn.start;
    const auto samples = closed_loop::simulate(controller, started, seed, request.duration);
    runs.push_back(closed_loop::summariseRun(samples, started, request.bounds));
    runs.back().seed = seed;
    runs.back().drawn = drawn;
    if (k > 0) continue;
    if (!request.csv.empty())
      writeTextFile(request.csv, [&](std::ostream& stream) { closed_loop::writeCsv(samples, stream); });
    if (request.runs == 1) print(closed_loop::summarise(samples, started));
  }
  if (!request.summary.empty())
    writeTextFile(request.summary, [&](std::ostream& stream) { closed_loop::writeRuns(runs, stream); });
  if (request.runs > 1) closed_loop::printRuns(runs, request.bounds, std::cout);
}

int run(const options::variables_map& values) {
  XmlRpc::XmlRpcValue tree;
  if (values.count("params") > 0) {
    for (const std::string& file : values["params"].as<std::vector<std::string>>()) {
      tree = mergeParameters(tree, parametersFromYaml(file));
    }
  }
  ParameterReader reader(tree, "");
  ServoSimulationParameters parameters;
  reader.readAll(parameters);
  const closed_loop::SimulationConfig& simulation = parameters.simulation;
  const ControllerNodeConfig& node = parameters.controller;
  const Request request = requestFrom(values, simulation, reader);
  if (!reader.errors().empty()) {
    std::cerr << "simulate_servo: " << reader.report() << '\n';
    return 1;
  }
  runAll(request, {node.control, node.rate}, simulation);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  options::options_description description(
      "simulate_servo [--params FILE.yaml]... [--seed N] [--duration S] --csv OUT.csv\n"
      "simulate_servo [--params FILE.yaml]... [--seed N] [--duration S] --runs N --summary OUT.csv [--csv OUT.csv]\n"
      "Runs the controller against an ideal scope about the insertion point, deterministically");
  description.add_options()("help,h", "print this text")(
      "params", options::value<std::vector<std::string>>()->composing(),
      "parameters, as in config/controller.yaml, config/simulate_servo.yaml and config/scenarios; later files overrule "
      "earlier ones")("seed", options::value<unsigned>()->default_value(1),
                      "seed of the noise, and of a start that is drawn")(
      "duration", options::value<double>(), "s, simulated time, instead of simulation/duration")(
      "csv", options::value<std::string>(), "the file to write, a line per step of the controller; of the first run")(
      "runs", options::value<int>()->default_value(1), "so many runs, with as many seeds from --seed on")(
      "summary", options::value<std::string>(), "the file to write, a line per run")(
      "settled-px", options::value<double>()->default_value(1.0),
      "px, of the summary: the centre is settled within it")(
      "settled-scale", options::value<double>()->default_value(1.0), "%, the same of the scale")(
      "settled-degrees", options::value<double>()->default_value(0.5), "degrees, the same of the orientation")(
      "rest-after", options::value<double>(),
      "s, from when on the summary's figures of rest are taken, instead of simulation/rest_from");
  try {
    options::variables_map values;
    options::store(options::parse_command_line(argc, argv, description), values);
    if (values.count("help") > 0) {
      std::cout << description;
      return 0;
    }
    options::notify(values);
    return run(values);
  } catch (const std::exception& error) {
    std::cerr << "simulate_servo: " << error.what() << '\n';
    return 1;
  }
}
