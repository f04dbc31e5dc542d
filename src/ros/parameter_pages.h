// The files and pages generated from the tables of parameters: config/*.yaml, and the text between the markers in
// doc/nodes/*.md. scripts/generate_parameters writes them, and a test compares them.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace laparoscope_servo {

struct ParameterPage {
  std::string file;  // relative to the package's folder
  std::function<std::string()> text;
};

// Pages of all programs that have parameters.
std::vector<ParameterPage> parameterPages();

// `old` with the generated text replaced: the whole of a YAML file, or the part between the markers of a page. Throws
// std::runtime_error for a page without markers.
std::string withParameters(const ParameterPage& page, const std::string& old);

}  // namespace laparoscope_servo
