#include "laparoscope_servo/parameters/row.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::parameters {

namespace {

using validation::numberText;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "nothing" : name);
  return text;
}

// `value` converted to the kind of a row: an integer to a number, an empty list to any list.
Value converted(const Value& value, Row::Kind kind) {
  if (kind == Row::Kind::kNumber && std::holds_alternative<int>(value))
    return static_cast<double>(std::get<int>(value));
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  if (kind == Row::Kind::kTexts && numbers != nullptr && numbers->empty()) return std::vector<std::string>();
  return value;
}

std::string element(std::size_t index) {
  return "[" + std::to_string(index) + "]";
}

}  // namespace

std::string typeName(const Value& value) {
  static const char* const kNames[] = {"a boolean", "an integer",        "a number",
                                       "a string",  "a list of numbers", "a list of strings"};
  return kNames[value.index()];
}

std::string valueText(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<int>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return numberText(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return "'" + *text + "'";
  return "";
}

std::optional<double> numberOf(const Value& value) {
  if (const auto* integer = std::get_if<int>(&value)) return *integer;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

const char* words(Row::Order order) {
  static const char* const kWords[] = {"at least", "at most", "above", "below"};
  return kWords[static_cast<int>(order)];
}

bool holds(Row::Order order, double value, double other) {
  switch (order) {
    case Row::Order::kAtLeast:
      return value >= other;
    case Row::Order::kAtMost:
      return value <= other;
    case Row::Order::kAbove:
      return value > other;
    case Row::Order::kBelow:
      return value < other;
  }
  return false;
}

Row& Row::whileRunning() {
  while_running = true;
  return *this;
}

Row& Row::related(Order order, const std::string& sibling) {
  relations.push_back({order, name.substr(0, name.rfind('/') + 1) + sibling});
  return *this;
}

Row& Row::accepting(const std::string& wanted, const std::function<bool(const std::string&)>& judge) {
  what = wanted;
  accepts = judge;
  return *this;
}

Row& Row::whole() {
  only_whole = true;
  return *this;
}

Row& Row::required(const std::string& sample) {
  is_required = true;
  return optional(sample);
}

Row& Row::optional(const std::string& sample) {
  example = sample;
  return *this;
}

std::string Row::expected() const {
  const bool bounded = std::isfinite(range.low) || std::isfinite(range.high);
  const std::string in = (bounded ? " in " + range.text() : "") + (unit.empty() ? "" : " " + unit);
  switch (kind) {
    case Kind::kFlag:
      return "true or false";
    case Kind::kInteger:
      return "an integer" + in;
    case Kind::kNumber:
      return "a number" + in;
    case Kind::kText:
      return !choices.empty() ? "one of: " + joined(choices) : what.empty() ? "a string" : what;
    case Kind::kNumbers:
      return "a list of " + (size > 0 ? std::to_string(size) + " " : "") + (only_whole ? "whole " : "") + "numbers" +
             in;
    case Kind::kTexts:
      return "a list of strings" + (what.empty() ? "" : ", each " + what);
  }
  return "";
}

std::string Row::textError(const std::string& text) const {
  const bool listed = choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
  return listed && (!accepts || accepts(text)) ? "" : " = '" + text + "', expected " + expected();
}

std::string Row::error(const Value& given) const {
  const Value value = converted(given, kind);
  if (value.index() != static_cast<std::size_t>(kind)) {
    const std::string text = valueText(value);
    return (text.empty() ? "" : " = " + text) + " is " + typeName(value) + ", expected " + expected();
  }
  if (const auto* text = std::get_if<std::string>(&value)) return textError(*text);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
    for (std::size_t k = 0; k < texts->size(); ++k) {
      const std::string wrong = textError((*texts)[k]);
      if (!wrong.empty()) return element(k) + wrong;
    }
    return "";
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    if (size > 0 && numbers->size() != size)
      return " has " + std::to_string(numbers->size()) + " elements, expected " + expected();
    for (std::size_t k = 0; k < numbers->size(); ++k) {
      const double number = (*numbers)[k];
      if (!range.contains(number) || (only_whole && number != std::floor(number)))
        return element(k) + " = " + numberText(number) + ", expected " + expected();
    }
    return "";
  }
  const auto* integer = std::get_if<int>(&value);
  const auto* number = std::get_if<double>(&value);
  const bool outside =
      (integer != nullptr && !range.contains(*integer)) || (number != nullptr && !range.contains(*number));
  return outside ? " = " + valueText(value) + ", expected " + expected() : "";
}

std::string Row::take(const Value& value) const {
  const std::string wrong = error(value);
  if (wrong.empty()) set(converted(value, kind));
  return wrong;
}

}  // namespace laparoscope_servo::parameters
