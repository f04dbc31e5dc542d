// The main program of a tool with options on its command line.
#pragma once

#include <boost/program_options.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

namespace laparoscope_servo {

// Returns the exit status: that of `run`, 1 if it throws, 2 for wrong options, 0 after --help, which prints `usage` and
// the options. Arguments that are no options are values of `positional`. `run` may also throw program_options::error.
template <class Run>
int runTool(int argc, char** argv, const std::string& name, const std::string& usage,
            const boost::program_options::options_description& description, const char* positional, const Run& run) {
  namespace options = boost::program_options;
  constexpr int kBadUsage = 2;
  try {
    options::positional_options_description places;
    places.add(positional, -1);
    options::variables_map map;
    options::store(options::command_line_parser(argc, argv).options(description).positional(places).run(), map);
    options::notify(map);
    if (map.count("help") > 0) {
      std::cout << usage << description;
      return EXIT_SUCCESS;
    }
    return run();
  } catch (const options::error& error) {
    std::cerr << name << ": " << error.what() << "; --help lists the options\n";
    return kBadUsage;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}

}  // namespace laparoscope_servo
