// Generates files and pages from a table of parameters. Defaults are the values of the configuration for which it was
// made.
#pragma once

#include <string>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::parameters {

// A YAML file of all parameters, each with its default and a comment: unit, range, meaning. Required parameters are
// commented out. `heading`: lines of text for the top.
std::string yamlPage(const Table& table, const std::string& heading);

// A table in Markdown with a line for each parameter; `prefix`, e.g. "~", is put in front of the names.
std::string markdownTable(const Table& table, const std::string& prefix);

// The type of its value: "bool", "int", "double", "string", "3 doubles", "list of strings".
std::string typeText(const Row& row);

// The value in YAML: 1.0, word, [1.0, 2.0].
std::string yamlText(const Value& value);

}  // namespace laparoscope_servo::parameters
