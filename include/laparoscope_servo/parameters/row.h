// A row of a table of parameters: everything about one parameter.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo::parameters {

using validation::Range;

// Value of a parameter, in the types of files and of the parameter server.
using Value = std::variant<bool, int, double, std::string, std::vector<double>, std::vector<std::string>>;

// "a boolean", "an integer" ...
std::string typeName(const Value& value);
// The value in texts of errors: 0.5, 'word', true; empty for a list.
std::string valueText(const Value& value);

// The value as a number, if it is one (integer or not).
std::optional<double> numberOf(const Value& value);

struct Row {
  enum class Kind { kFlag, kInteger, kNumber, kText, kNumbers, kTexts };
  enum class Order { kAtLeast, kAtMost, kAbove, kBelow };
  struct Relation {
    Order order;
    std::string other;  // full name
  };

  // The parameter may change while the program runs.
  Row& whileRunning();
  // Relation to another number of its group.
  Row& atLeast(const std::string& sibling) { return related(Order::kAtLeast, sibling); }
  Row& atMost(const std::string& sibling) { return related(Order::kAtMost, sibling); }
  Row& above(const std::string& sibling) { return related(Order::kAbove, sibling); }
  Row& below(const std::string& sibling) { return related(Order::kBelow, sibling); }
  // Condition on a text, or on each text of a list. `what`: the expected text in errors, "the name of a tf frame".
  Row& accepting(const std::string& what, const std::function<bool(const std::string&)>& accepts);
  // All numbers of the list must be integers.
  Row& whole();
  // Has no default and must be given; `example` is shown in files.
  Row& required(const std::string& example);
  // Is empty by default; files hold it as a comment only, with `example`.
  Row& optional(const std::string& example);

  // Why `value` is refused, to be appended to the name: " = 7, expected a number in [0, 5] 1/s". Empty if it is
  // accepted.
  std::string error(const Value& value) const;
  // Sets the value if there is no error(); returns that error. An integer is accepted for a number.
  std::string take(const Value& value) const;
  // "a number in [0, 5] 1/s"
  std::string expected() const;

  std::string name;  // full name, with slashes
  Kind kind;
  Range range = Range::finite();
  std::vector<std::string> choices;  // allowed texts; empty: any
  std::size_t size = 0;              // number of entries of a list; 0: any
  bool only_whole = false;           // see whole()
  std::string unit;                  // empty: none
  std::string meaning;               // one plain sentence, without a full stop
  bool while_running = false;
  std::string example;  // of a required or optional parameter, else empty
  bool is_required = false;
  std::string what;  // see accepting()
  std::function<bool(const std::string&)> accepts;
  std::vector<Relation> relations;
  std::function<Value()> get;
  std::function<void(const Value&)> set;

 private:
  Row& related(Order order, const std::string& sibling);
  std::string textError(const std::string& text) const;
};

// "at least"
const char* words(Row::Order order);
bool holds(Row::Order order, double value, double other);

}  // namespace laparoscope_servo::parameters
