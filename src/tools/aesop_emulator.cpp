// aesop_emulator: the far end of the serial line, as a process behind a pseudo-terminal.
#include <ros/init.h>

#include <atomic>
#include <boost/program_options.hpp>
#include <csignal>
#include <iostream>

#include "laparoscope_servo/sim/emulator_control.h"
#include "laparoscope_servo/sim/emulator_server.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/simulation/emulator_script.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

std::atomic<bool> stop{false};

void onSignal(int) {
  stop = true;
}

options::options_description description() {
  options::options_description text("Usage: aesop_emulator --link PATH [options]");
  // clang-format off
  text.add_options()
    ("help,h", "this text")
    ("link", options::value<std::string>(), "where to put the port: a symbolic link to a pseudo-terminal")
    ("control", options::value<std::string>()->default_value(""), "Unix socket for requests that are not on the wire; none when empty")
    ("params", options::value<std::vector<std::string>>()->composing(),
     "YAML file with the groups `kinematics` and `emulator`; may be given several times, later ones win")
    ("script", options::value<std::string>(), "YAML file of faults and when they come")
    ("baud", options::value<int>()->default_value(0), "bit/s, 1200 to 1000000: bytes take as long as on a line, ten bits each; 0: no time")
    ("seed", options::value<unsigned>()->default_value(1), "of the dice for faults of the line");
  // clang-format on
  return text;
}

sim::EmulatorConfig readConfig(const options::variables_map& values) {
  XmlRpc::XmlRpcValue tree;
  if (values.count("params") > 0) {
    for (const std::string& file : values["params"].as<std::vector<std::string>>()) {
      tree = mergeParameters(tree, parametersFromYaml(file));
    }
  }
  ParameterReader reader(tree, "params");
  const sim::EmulatorConfig config = readEmulatorConfig(reader);
  for (const std::string& error : errorsBesideEmulator(tree)) reader.addError(error);
  if (!reader.errors().empty()) throw std::runtime_error(reader.report());
  return config;
}

sim::ServerConfig readServer(const options::variables_map& values) {
  if (values.count("link") == 0) throw std::runtime_error("--link is missing: a path for the port is needed");
  sim::ServerConfig server;
  server.link = values["link"].as<std::string>();
  server.control = values["control"].as<std::string>();
  server.seed = values["seed"].as<unsigned>();
  server.baud_rate = values["baud"].as<int>();
  if (server.baud_rate != 0 && !(server.baud_rate >= 1200 && server.baud_rate <= 1000000)) {
    throw std::runtime_error("--baud " + std::to_string(server.baud_rate) + ": expected 0, or 1200 to 1000000 bit/s");
  }
  if (values.count("script") > 0) server.script = scriptFromYaml(values["script"].as<std::string>());
  return server;
}

int run(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);  // roslaunch adds some
  arguments.erase(arguments.begin());
  options::variables_map values;
  options::store(options::command_line_parser(arguments).options(description()).run(), values);
  options::notify(values);
  if (values.count("help") > 0) {
    std::cout << description() << "\nRequests on the control socket, a line each, each answered by a line:\n"
              << sim::emulatorControlHelp();
    return 0;
  }
  const sim::ServerConfig config = readServer(values);
  sim::EmulatorServer server(readConfig(values), config);
  std::cout << "port " << config.link << " -> " << server.device() << std::endl;
  server.run(stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "aesop_emulator: " << error.what() << std::endl;
    return 1;
  }
}
