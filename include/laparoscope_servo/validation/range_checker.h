// Collects the errors of a configuration's fields, for the validate() functions of all parts.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo::validation {

class RangeChecker {
 public:
  // Adds an error unless the value is in [minimum, maximum]; also for NaN. `unit` is appended to the text.
  template <typename T>
  void range(const std::string& field, T value, T minimum, T maximum, const std::string& unit = "") {
    const Range bounds(static_cast<double>(minimum), static_cast<double>(maximum));
    if (bounds.contains(static_cast<double>(value))) return;
    add(field + " = " + numberText(static_cast<double>(value)) + ", expected a number in " + bounds.text() +
        (unit.empty() ? "" : " ") + unit);
  }

  void add(const std::string& error) { errors_.push_back(error); }

  // The errors, in the order in which they were found.
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  std::vector<std::string> errors_;
};

}  // namespace laparoscope_servo::validation
