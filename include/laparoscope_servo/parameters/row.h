// A row of a table of parameters: all that is to be known of one of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo::parameters {

using validation::Range;

// What a parameter holds, as files and the parameter server know it.
using Value = std::variant<bool, int, double, std::string, std::vector<double>, std::vector<std::string>>;

// "a boolean", "an integer" ...
std::string typeName(const Value& value);
// As errors name it: 0.5, 'word', true; empty for a list.
std::string valueText(const Value& value);

// Of a number, whole or not.
std::optional<double> numberOf(const Value& value);

struct Row {
  enum class Kind { kFlag, kInteger, kNumber, kText, kNumbers, kTexts };
  enum class Order { kAtLeast, kAtMost, kAbove, kBelow };
  struct Relation {
    Order order;
    std::string other;  // whole name
  };

  // May change while the program runs.
  Row& whileRunning();
  // How it lies to another number of its group.
  Row& atLeast(const std::string& sibling) { return related(Order::kAtLeast, sibling); }
  Row& atMost(const std::string& sibling) { return related(Order::kAtMost, sibling); }
  Row& above(const std::string& sibling) { return related(Order::kAbove, sibling); }
  Row& below(const std::string& sibling) { return related(Order::kBelow, sibling); }
  // Of a text, or of each one of a list: `what` it has to be, "the name of a tf frame".
  Row& accepting(const std::string& what, const std::function<bool(const std::string&)>& accepts);
  // Of a list of numbers: each is a whole one.
  Row& whole();
  // There is no default: it has to be given, as `example` is.
  Row& required(const std::string& example);
  // Nothing is its default: a file has it as a comment only, with `example`.
  Row& optional(const std::string& example);

  // Why `value` cannot be taken, to be put behind the name: " = 7, expected a number in [0, 5] 1/s". Empty when it can
  // be.
  std::string error(const Value& value) const;
  // Takes the value when there is no error(), which is returned. A whole number is taken for a number.
  std::string take(const Value& value) const;
  // "a number in [0, 5] 1/s"
  std::string expected() const;

  std::string name;  // whole, with slashes
  Kind kind;
  Range range = Range::finite();
  std::vector<std::string> choices;  // of a text; empty: any
  std::size_t size = 0;              // of a list; 0: any
  bool only_whole = false;           // see whole()
  std::string unit;                  // empty: none
  std::string meaning;               // one plain sentence, without a full stop
  bool while_running = false;
  std::string example;  // of one that is required or optional, else empty
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
