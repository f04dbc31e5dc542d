// The parameters of a program, defined once: name, range, unit, meaning, and the field of the configuration.
//
// Each configuration struct, with its defaults, has a function describe(table, config) that adds a row for each
// parameter. Reading parameters, the ranges in validate(), the files in config/, the tables in doc/nodes/ and
// dynamic_reconfigure all use these rows. A table refers to the configuration for which it was made, and must not
// outlive it.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/row.h"

namespace laparoscope_servo::parameters {

class Table {
 public:
  // Each adds a row and returns it for further settings. `meaning`: a plain sentence without a full stop.
  Row& flag(const std::string& name, bool& value, const std::string& meaning);
  Row& number(const std::string& name, double& value, const Range& range, const std::string& unit,
              const std::string& meaning);
  Row& number(const std::string& name, int& value, const Range& range, const std::string& unit,
              const std::string& meaning);
  Row& text(const std::string& name, std::string& value, const std::string& meaning);
  Row& texts(const std::string& name, std::vector<std::string>& value, const std::string& meaning);
  // One of `names`, which are in the order of the enumeration's values.
  template <class Enum>
  Row& choice(const std::string& name, Enum& value, const std::vector<std::string>& names, const std::string& meaning) {
    return choice(
        name, names, [&value] { return static_cast<std::size_t>(value); },
        [&value](std::size_t index) { value = static_cast<Enum>(index); }, meaning);
  }
  Row& choice(const std::string& name, std::string& value, const std::vector<std::string>& names,
              const std::string& meaning);
  // choice() by the index in the list of names.
  Row& choice(const std::string& name, const std::vector<std::string>& names, const std::function<std::size_t()>& get,
              const std::function<void(std::size_t)>& set, const std::string& meaning);
  // `size` numbers, or any number of them when it is 0.
  Row& numbers(const std::string& name, std::vector<double>& value, std::size_t size, const Range& range,
               const std::string& unit, const std::string& meaning);
  // `size` numbers, `stride` apart: an array, a vector, or a field of several structs.
  Row& numbers(const std::string& name, double* first, std::size_t size, const Range& range, const std::string& unit,
               const std::string& meaning, std::size_t stride = sizeof(double));
  // Any other parameter, by functions.
  Row& other(const std::string& name, Row::Kind kind, const std::function<Value()>& get,
             const std::function<void(const Value&)>& set, const std::string& meaning);

  // The rows that `add` adds belong to the group `name`, within the present group.
  void group(const std::string& name, const std::string& meaning, const std::function<void()>& add);

  // All errors of the configuration, each with parameter, value, and what was expected.
  std::vector<std::string> errors() const;

  const std::deque<Row>& rows() const { return rows_; }
  // The row of this full name, or null.
  const Row* find(const std::string& name) const;
  std::set<std::string> names() const;
  // Empty for a group without a meaning, and if there is no such group.
  std::string meaningOfGroup(const std::string& name) const;

 private:
  Row& add(const std::string& name, Row::Kind kind, const std::string& meaning);
  std::string relationError(const Row& row) const;

  std::deque<Row> rows_;  // a deque, so that references to rows stay valid
  std::map<std::string, std::string> groups_;
  std::string prefix_;  // name of the present group, with a slash at its end
};

// The errors of a configuration by its table alone.
template <class Config>
std::vector<std::string> errorsOf(const Config& config) {
  Config copy = config;
  Table table;
  describe(table, copy);
  return table.errors();
}

// Copies from `from` the parameters that may change while the program runs.
template <class Config>
void copyWhatMayChange(const Config& from, Config& to) {
  Config copy = from;
  Table source;
  Table target;
  describe(source, copy);
  describe(target, to);
  for (std::size_t k = 0; k < source.rows().size(); ++k) {
    if (source.rows()[k].while_running) target.rows()[k].set(source.rows()[k].get());
  }
}

}  // namespace laparoscope_servo::parameters
