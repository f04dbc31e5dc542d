// A table of parameters in the messages of dynamic_reconfigure: those that may change while the node runs.
//
// The tools of dynamic_reconfigure want names that are C identifiers: a slash is written as two underscores,
// tracking__quality__min_zncc.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include <map>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

// Appends to a list of a Config: doubles, ints, bools or strs.
template <class List, class T>
void appendTo(List& list, const std::string& name, const T& value) {
  typename List::value_type parameter;
  parameter.name = name;
  parameter.value = value;
  list.push_back(parameter);
}

std::string reconfigureName(const std::string& path);
// Takes names with slashes, too.
std::string pathOfReconfigureName(const std::string& name);

// Names, types, ranges and meanings; the values of the table are the defaults.
dynamic_reconfigure::ConfigDescription describeForReconfigure(const parameters::Table& table);
dynamic_reconfigure::Config valuesForReconfigure(const parameters::Table& table);

// Sets in the configuration of the table what `wanted` asks for. Returns every error, and then has changed nothing: a
// name that is unknown, twice there, or of a parameter that may not change while the node runs; a wrong type; a value
// that cannot be taken.
std::vector<std::string> setFromReconfigure(const parameters::Table& table, const dynamic_reconfigure::Config& wanted);

// Values of what may change, by their paths.
std::map<std::string, parameters::Value> changeable(const parameters::Table& table);
void restore(const parameters::Table& table, const std::map<std::string, parameters::Value>& values);

}  // namespace laparoscope_servo
