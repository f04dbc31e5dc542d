// Converts the parameters of a table that may change while the node runs to messages of dynamic_reconfigure.
//
// The tools of dynamic_reconfigure need names that are C identifiers, so a slash is written as two underscores:
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
// Accepts names with slashes too.
std::string pathOfReconfigureName(const std::string& name);

// Names, types, ranges and meanings; the values of the table are the defaults.
dynamic_reconfigure::ConfigDescription describeForReconfigure(const parameters::Table& table);
dynamic_reconfigure::Config valuesForReconfigure(const parameters::Table& table);

// Sets the values of `wanted` in the configuration of the table. Returns all errors, and then changes nothing: a name
// that is unknown, given twice, or of a parameter that may not change while the node runs; a wrong type; a refused
// value.
std::vector<std::string> setFromReconfigure(const parameters::Table& table, const dynamic_reconfigure::Config& wanted);

// Values of the parameters that may change, by their paths.
std::map<std::string, parameters::Value> changeable(const parameters::Table& table);
void restore(const parameters::Table& table, const std::map<std::string, parameters::Value>& values);

}  // namespace laparoscope_servo
