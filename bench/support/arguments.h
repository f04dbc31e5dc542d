// What the programs' command lines have in common.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// "x,y,w,h"; throws std::invalid_argument, with the text.
geometry::Rectangle parseRoi(const std::string& text);

// "3" or "1:20" or "1:20:2", ends included, step 1 by default; throws std::invalid_argument.
std::vector<double> parseRange(const std::string& text);

// Reads the command line into the options' variables; arguments without a name are `positional`, at most so many of
// them, or any number for -1. The exit status where that is all: help was asked for, or `complete` says no, and the
// options have been printed.
std::optional<int> parse(int argc, char** argv, const boost::program_options::options_description& options,
                         const char* positional, int most, const std::function<bool()>& complete);

// A file to write, not open for an empty name. Throws std::runtime_error, with the name, when it cannot be written;
// what cannot be written on throws std::ios::failure.
std::ofstream create(const std::string& file);

// Runs a program's body; what it throws is printed, with the program's name, and becomes exit status 1.
int run(const char* program, const std::function<int()>& body);

}  // namespace laparoscope_servo::bench
