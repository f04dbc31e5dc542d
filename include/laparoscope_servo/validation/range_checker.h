// Collects what is wrong with the fields of a configuration, for the validate() functions of all parts.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace laparoscope_servo::validation {

class RangeChecker {
 public:
  // An error unless minimum <= value <= maximum, so for NaN, too. `unit` ends the text where there is one.
  template <typename T>
  void range(const std::string& field, T value, T minimum, T maximum, const std::string& unit = "") {
    if (value >= minimum && value <= maximum) return;
    std::ostringstream text;
    text << field << " = " << value << ", expected a number from " << minimum << " to " << maximum
         << (unit.empty() ? "" : " ") << unit;
    add(text.str());
  }

  void add(const std::string& error) { errors_.push_back(error); }

  // One for each field, in the order in which they were found.
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  std::vector<std::string> errors_;
};

}  // namespace laparoscope_servo::validation
