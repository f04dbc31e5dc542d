// The files and pages that are made of the tables of parameters: config/*.yaml, and what stands between the markers in
// doc/nodes/*.md. scripts/generate_parameters writes them, and a test compares them.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace laparoscope_servo {

struct ParameterPage {
  std::string file;  // in the package's folder
  std::function<std::string()> text;
};

// Of all programs that have parameters.
std::vector<ParameterPage> parameterPages();

// `old` with the page's text in the place of what was made before: the whole of a YAML file, the part between the
// markers of a page. Throws std::runtime_error for a page without markers.
std::string withParameters(const ParameterPage& page, const std::string& old);

}  // namespace laparoscope_servo
