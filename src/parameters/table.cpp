#include "laparoscope_servo/parameters/table.h"

#include <algorithm>
#include <cstring>

namespace laparoscope_servo::parameters {

namespace {

template <class T>
void bind(Row& row, T& value) {
  row.get = [&value] { return Value(value); };
  row.set = [&value](const Value& given) { value = std::get<T>(given); };
}

}  // namespace

Row& Table::add(const std::string& name, Row::Kind kind, const std::string& meaning) {
  Row row;
  row.name = prefix_ + name;
  row.kind = kind;
  row.meaning = meaning;
  rows_.push_back(row);
  return rows_.back();
}

Row& Table::flag(const std::string& name, bool& value, const std::string& meaning) {
  Row& row = add(name, Row::Kind::kFlag, meaning);
  bind(row, value);
  return row;
}

Row& Table::number(const std::string& name, double& value, const Range& range, const std::string& unit,
                   const std::string& meaning) {
  Row& row = add(name, Row::Kind::kNumber, meaning);
  row.range = range;
  row.unit = unit;
  bind(row, value);
  return row;
}

Row& Table::number(const std::string& name, int& value, const Range& range, const std::string& unit,
                   const std::string& meaning) {
  Row& row = add(name, Row::Kind::kInteger, meaning);
  row.range = range;
  row.unit = unit;
  bind(row, value);
  return row;
}

Row& Table::text(const std::string& name, std::string& value, const std::string& meaning) {
  Row& row = add(name, Row::Kind::kText, meaning);
  bind(row, value);
  return row;
}

Row& Table::texts(const std::string& name, std::vector<std::string>& value, const std::string& meaning) {
  Row& row = add(name, Row::Kind::kTexts, meaning);
  bind(row, value);
  return row;
}

Row& Table::choice(const std::string& name, std::string& value, const std::vector<std::string>& names,
                   const std::string& meaning) {
  Row& row = text(name, value, meaning);
  row.choices = names;
  return row;
}

Row& Table::choice(const std::string& name, const std::vector<std::string>& names,
                   const std::function<std::size_t()>& get, const std::function<void(std::size_t)>& set,
                   const std::string& meaning) {
  Row& row = add(name, Row::Kind::kText, meaning);
  row.choices = names;
  row.get = [names, get] { return Value(names.at(get())); };
  row.set = [names, set](const Value& value) {
    set(static_cast<std::size_t>(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin()));
  };
  return row;
}

Row& Table::numbers(const std::string& name, std::vector<double>& value, std::size_t size, const Range& range,
                    const std::string& unit, const std::string& meaning) {
  Row& row = add(name, Row::Kind::kNumbers, meaning);
  row.size = size;
  row.range = range;
  row.unit = unit;
  bind(row, value);
  return row;
}

Row& Table::numbers(const std::string& name, double* first, std::size_t size, const Range& range,
                    const std::string& unit, const std::string& meaning, std::size_t stride) {
  Row& row = add(name, Row::Kind::kNumbers, meaning);
  row.size = size;
  row.range = range;
  row.unit = unit;
  const auto element = [first, stride](std::size_t k) { return reinterpret_cast<char*>(first) + k * stride; };
  row.get = [size, element] {
    std::vector<double> values(size);
    for (std::size_t k = 0; k < size; ++k) std::memcpy(&values[k], element(k), sizeof(double));
    return Value(values);
  };
  row.set = [size, element](const Value& value) {
    const auto& values = std::get<std::vector<double>>(value);
    for (std::size_t k = 0; k < size; ++k) std::memcpy(element(k), &values[k], sizeof(double));
  };
  return row;
}

Row& Table::other(const std::string& name, Row::Kind kind, const std::function<Value()>& get,
                  const std::function<void(const Value&)>& set, const std::string& meaning) {
  Row& row = add(name, kind, meaning);
  row.get = get;
  row.set = set;
  return row;
}

void Table::group(const std::string& name, const std::string& meaning, const std::function<void()>& add) {
  const std::string outside = prefix_;
  groups_[prefix_ + name] = meaning;
  prefix_ += name + "/";
  add();
  prefix_ = outside;
}

std::vector<std::string> Table::errors() const {
  std::vector<std::string> errors;
  for (const Row& row : rows_) {
    std::string error = row.error(row.get());
    if (error.empty()) error = relationError(row);
    if (!error.empty()) errors.push_back(row.name + error);
  }
  return errors;
}

// A value outside of its own range gives only that error.
std::string Table::relationError(const Row& row) const {
  for (const Row::Relation& relation : row.relations) {
    const Row& other = *find(relation.other);
    const auto value = numberOf(row.get());
    const auto bound = numberOf(other.get());
    if (!value || !bound || !other.error(other.get()).empty() || holds(relation.order, *value, *bound)) continue;
    return " = " + valueText(row.get()) + ", expected " + words(relation.order) + " " +
           other.name.substr(other.name.rfind('/') + 1) + " = " + valueText(other.get());
  }
  return "";
}

const Row* Table::find(const std::string& name) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.name == name; });
  return found == rows_.end() ? nullptr : &*found;
}

std::set<std::string> Table::names() const {
  std::set<std::string> names;
  for (const Row& row : rows_) names.insert(row.name);
  return names;
}

std::string Table::meaningOfGroup(const std::string& name) const {
  const auto found = groups_.find(name);
  return found == groups_.end() ? "" : found->second;
}

}  // namespace laparoscope_servo::parameters
