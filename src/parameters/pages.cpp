#include "laparoscope_servo/parameters/pages.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace laparoscope_servo::parameters {

namespace {

using validation::numberText;

constexpr std::size_t kWidestEntry = 44;  // wider entries do not move the comments of their neighbours
constexpr char kWhileRunning[] = " May change while it runs.";

// With a decimal point, without which YAML 1.1 reads 1e+09 as a text.
std::string yamlNumber(double value) {
  std::string text = numberText(value);
  if (!std::isfinite(value) || text.find('.') != std::string::npos) return text;
  return text.insert(std::min(text.size(), text.find('e')), ".0");
}

// A word that YAML can only read as a text needs no quotes.
std::string yamlString(const std::string& text) {
  static const char* const kOther[] = {"true", "false", "yes", "no", "on", "off", "null", "y", "n"};
  bool plain = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
  for (const char c : text) plain &= std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
  for (const char* word : kOther) plain &= text != word;
  if (plain || text.find('\'') != std::string::npos) return text;
  return "'" + text + "'";
}

template <class List, class Text>
std::string joined(const List& list, const Text& text) {
  std::string result;
  for (const auto& element : list) result += (result.empty() ? "" : ", ") + text(element);
  return result;
}

std::size_t depthOf(const std::string& path) {
  return static_cast<std::size_t>(std::count(path.begin(), path.end(), '/'));
}

std::string indent(std::size_t depth) {
  return std::string(2 * depth, ' ');
}

std::string lastName(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

std::string groupOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

// Bounds, choices or the expected text, and relations to other parameters.
std::string rangeText(const Row& row, const std::string& quote) {
  std::string text;
  if (std::isfinite(row.range.low) || std::isfinite(row.range.high)) text = row.range.text();
  if (!row.choices.empty())
    text =
        joined(row.choices, [&](const std::string& name) { return name.empty() ? "nothing" : quote + name + quote; });
  if (!row.what.empty()) text = row.what;
  for (const Row::Relation& relation : row.relations) {
    text += (text.empty() ? "" : ", ") + std::string(words(relation.order)) + " " + quote + lastName(relation.other) +
            quote;
  }
  return text;
}

std::string comment(const Row& row) {
  std::string text = row.unit;
  const std::string range = rangeText(row, "");
  if (!range.empty()) text += (text.empty() ? "" : ", ") + range;
  return text + (text.empty() ? "" : ": ") + row.meaning + (row.while_running ? std::string(".") + kWhileRunning : "");
}

std::string entry(const Row& row) {
  const std::string name = indent(depthOf(row.name)) + lastName(row.name) + ": ";
  if (!row.example.empty()) return "# " + name + row.example;
  const Value value = row.get();
  if (!row.only_whole) return name + yamlText(value);
  return name + "[" + joined(std::get<std::vector<double>>(value), numberText) + "]";
}

// The rows of a group are adjacent: prints a line for the group's name if the last row is in another group.
void enterGroup(const Table& table, const std::string& before, const std::string& group, std::size_t column,
                std::ostringstream& page) {
  if (group.empty() || (before + "/").rfind(group + "/", 0) == 0) return;
  enterGroup(table, before, groupOf(group), column, page);
  std::string line = indent(depthOf(group)) + lastName(group) + ":";
  const std::string meaning = table.meaningOfGroup(group);
  if (!meaning.empty())
    line += std::string(std::max<std::size_t>(column, line.size() + 2) - line.size(), ' ') + "# " + meaning;
  page << line << '\n';
}

std::string topOf(const std::string& path) {
  return path.find('/') == std::string::npos ? "" : path.substr(0, path.find('/'));
}

// Column of the comments of a top-level group.
std::size_t columnOf(const Table& table, const std::string& top) {
  std::size_t widest = 0;
  for (const Row& row : table.rows()) {
    const std::size_t width = entry(row).size();
    if (topOf(row.name) == top && width <= kWidestEntry) widest = std::max(widest, width);
  }
  return widest + 2;
}

std::string markdownDefault(const Row& row) {
  if (!row.example.empty()) return row.is_required ? "required" : "none";
  const Value value = row.get();
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    return joined(*numbers, [](double number) {
      std::ostringstream text;
      text.precision(4);
      text << number;
      return text.str();
    });
  }
  if (const auto* text = std::get_if<std::string>(&value)) return text->empty() ? "empty" : *text;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
    return texts->empty() ? "empty" : joined(*texts, [](const std::string& text) { return text; });
  }
  return valueText(value);
}

}  // namespace

std::string typeText(const Row& row) {
  switch (row.kind) {
    case Row::Kind::kFlag:
      return "bool";
    case Row::Kind::kInteger:
      return "int";
    case Row::Kind::kNumber:
      return "double";
    case Row::Kind::kText:
      return "string";
    case Row::Kind::kNumbers:
      return row.size > 0 ? std::to_string(row.size) + " doubles" : "list of doubles";
    case Row::Kind::kTexts:
      return "list of strings";
  }
  return "";
}

std::string yamlText(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return yamlNumber(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return yamlString(*text);
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return "[" + joined(*numbers, yamlNumber) + "]";
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) return "[" + joined(*texts, yamlString) + "]";
  return valueText(value);
}

std::string yamlPage(const Table& table, const std::string& heading) {
  std::ostringstream page;
  std::istringstream lines(heading);
  for (std::string line; std::getline(lines, line);) page << "# " << line << '\n';
  std::string before;
  std::string top = "/";  // matches no group
  std::size_t column = 0;
  for (const Row& row : table.rows()) {
    if (topOf(row.name) != top) {
      top = topOf(row.name);
      column = columnOf(table, top);
      page << '\n';
    }
    const std::string group = groupOf(row.name);
    enterGroup(table, before, group, column, page);
    before = group;
    const std::string line = entry(row);
    page << line << std::string(std::max(column, line.size() + 2) - line.size(), ' ') << "# " << comment(row) << '\n';
  }
  return page.str();
}

std::string markdownTable(const Table& table, const std::string& prefix) {
  std::ostringstream page;
  page << "| parameter | type | default | range | unit | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  std::string before;
  for (const Row& row : table.rows()) {
    const std::string group = groupOf(row.name);
    if (group != before && !table.meaningOfGroup(group).empty())
      page << "| **`" << prefix << group << "/`** | | | | | *" << table.meaningOfGroup(group) << "* |\n";
    before = group;
    page << "| `" << prefix << row.name << "` | " << typeText(row) << " | " << markdownDefault(row) << " | "
         << rangeText(row, "`") << " | " << row.unit << " | " << row.meaning
         << (row.while_running ? std::string(".") + kWhileRunning : "") << " |\n";
  }
  return page.str();
}

}  // namespace laparoscope_servo::parameters
