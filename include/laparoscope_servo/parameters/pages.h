// What files and pages say of a table of parameters. Defaults are the values of the configuration that it was made of.
#pragma once

#include <string>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::parameters {

// A file of all parameters, each with its default and a comment: unit, range, meaning. One that is required is a
// comment as a whole. `heading`: lines of text for the top.
std::string yamlPage(const Table& table, const std::string& heading);

// A table in Markdown with a line for each parameter, whose names have `prefix` in front of them, e.g. "~".
std::string markdownTable(const Table& table, const std::string& prefix);

// As YAML holds it: 1.0, word, [1.0, 2.0].
std::string yamlText(const Value& value);

}  // namespace laparoscope_servo::parameters
