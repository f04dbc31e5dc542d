// simulate_servo: the closed loop without ROS, see laparoscope_servo/ros/servo_simulation.h.
#include <boost/program_options.hpp>
#include <fstream>
#include <iostream>

#include "laparoscope_servo/ros/servo_simulation.h"

namespace options = boost::program_options;
namespace skin = laparoscope_servo::skin;

namespace {

void print(const skin::SimulationSummary& summary) {
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

int run(const options::variables_map& values) {
  XmlRpc::XmlRpcValue tree;
  if (values.count("params") > 0) {
    for (const std::string& file : values["params"].as<std::vector<std::string>>()) {
      tree = skin::mergeParameters(tree, skin::parametersFromYaml(file));
    }
  }
  skin::ParameterReader reader(tree, "");
  const skin::SimulationConfig simulation = skin::simulationConfig(reader);
  const skin::ControllerNodeConfig controller = skin::controllerNodeConfig(reader);
  const double duration = values["duration"].as<double>();
  if (!(duration > 0.0 && duration <= 36000.0)) {
    reader.addError("--duration = " + std::to_string(duration) + ", expected a number above 0, at most 36000 s");
  }
  if (!reader.errors().empty()) {
    std::cerr << "simulate_servo: " << reader.report() << '\n';
    return 1;
  }
  const auto samples = skin::simulate(controller, simulation, values["seed"].as<unsigned>(), duration);
  std::ofstream file(values["csv"].as<std::string>());
  skin::writeCsv(samples, file);
  file.close();
  if (!file) {
    std::cerr << "simulate_servo: cannot write '" << values["csv"].as<std::string>() << "'\n";
    return 1;
  }
  print(skin::summarise(samples, simulation));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  options::options_description description(
      "simulate_servo [--params FILE.yaml]... [--seed N] [--duration S] --csv OUT.csv\n"
      "Runs the controller against an ideal scope about the insertion point, deterministically");
  description.add_options()("help,h", "print this text")(
      "params", options::value<std::vector<std::string>>()->composing(),
      "parameters, as in config/controller.yaml and config/simulate_servo.yaml; later files overrule earlier ones")(
      "seed", options::value<unsigned>()->default_value(1), "seed of the noise")(
      "duration", options::value<double>()->default_value(20.0), "s, simulated time")(
      "csv", options::value<std::string>()->required(), "the file to write, a line per step of the controller");
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
