// What the programs' command lines have in common.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// "x,y,w,h"; throws std::invalid_argument, with the text.
geometry::Rectangle parseRoi(const std::string& text);

// "3" or "1:20" or "1:20:2", ends included, step 1 by default; throws std::invalid_argument.
std::vector<double> parseRange(const std::string& text);

// Runs a program's body; what it throws is printed, with the program's name, and becomes exit status 1.
int run(const char* program, const std::function<int()>& body);

}  // namespace laparoscope_servo::bench
