// The parameters of a program, told once: name, range, unit, meaning, and where each stands in a configuration.
//
// Beside a struct with its defaults stands a function describe(table, config) that adds a row for each parameter. From
// the rows come reading, the ranges that validate() judges, the files in config/, the tables in doc/nodes/, and what
// may change while the program runs. A table refers to the configuration that it was made of, and must not outlive it.
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
  // Each adds a row, to be refined by what it returns. `meaning`: a plain sentence without a full stop.
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
  // By the place in the list of names.
  Row& choice(const std::string& name, const std::vector<std::string>& names, const std::function<std::size_t()>& get,
              const std::function<void(std::size_t)>& set, const std::string& meaning);
  // `size` numbers, or any number of them when it is 0.
  Row& numbers(const std::string& name, std::vector<double>& value, std::size_t size, const Range& range,
               const std::string& unit, const std::string& meaning);
  // `size` numbers, each as far behind the one before as `stride` says: an array, a vector, a field of several structs.
  Row& numbers(const std::string& name, double* first, std::size_t size, const Range& range, const std::string& unit,
               const std::string& meaning, std::size_t stride = sizeof(double));
  // Anything else, by functions.
  Row& other(const std::string& name, Row::Kind kind, const std::function<Value()>& get,
             const std::function<void(const Value&)>& set, const std::string& meaning);

  // The rows that `add` adds are in the group `name`, within the group that is being added to.
  void group(const std::string& name, const std::string& meaning, const std::function<void()>& add);

  // What is wrong with the configuration as it is: each names parameter, value, and what was expected.
  std::vector<std::string> errors() const;

  const std::deque<Row>& rows() const { return rows_; }
  // Null when there is none of this whole name.
  const Row* find(const std::string& name) const;
  std::set<std::string> names() const;
  // Empty for a group without one, and where there is no such group.
  std::string meaningOfGroup(const std::string& name) const;

 private:
  Row& add(const std::string& name, Row::Kind kind, const std::string& meaning);
  std::string relationError(const Row& row) const;

  std::deque<Row> rows_;  // references to rows stay
  std::map<std::string, std::string> groups_;
  std::string prefix_;  // of the group that is being added to, with a slash behind it
};

// What is wrong with a configuration by its table alone.
template <class Config>
std::vector<std::string> errorsOf(const Config& config) {
  Config copy = config;
  Table table;
  describe(table, copy);
  return table.errors();
}

// Of `from`, what may change while the program runs.
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
