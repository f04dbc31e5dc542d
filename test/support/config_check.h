// What the tests of all configurations ask: that each row of a table is the field of its name, and that a number out of
// its range is refused by name.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::test_support {

template <class Config>
struct NumberField {
  NumberField(const std::string& field, double Config::*member)
      : name(field),
        get([member](const Config& c) { return c.*member; }),
        set([member](Config& c, double value) { c.*member = value; }) {}
  NumberField(const std::string& field, int Config::*member)
      : name(field),
        get([member](const Config& c) { return static_cast<double>(c.*member); }),
        set([member](Config& c, double value) { c.*member = static_cast<int>(value); }),
        whole(true) {}
  // A field of a field.
  NumberField(const std::string& field, const std::function<double&(Config&)>& at)
      : name(field),
        get([at](const Config& c) {
          Config copy = c;
          return at(copy);
        }),
        set([at](Config& c, double value) { at(c) = value; }) {}

  std::string name;
  std::function<double(const Config&)> get;
  std::function<void(Config&, double)> set;
  bool whole = false;  // an integer
};

// Whether one of the errors is about this field.
inline bool names(const std::vector<std::string>& errors, const std::string& field) {
  for (const std::string& error : errors) {
    if (error.rfind(field + " = ", 0) == 0) return true;
  }
  return false;
}

// Each row of the table with a number is the field of that name, and no other; `fields` are all of them but `others`,
// which belong to a part of the configuration.
template <class Config>
void expectRowsAreFields(const std::vector<NumberField<Config>>& fields, std::size_t others = 0) {
  using parameters::Row;
  Config config;
  parameters::Table table;
  describe(table, config);
  std::size_t numbers = 0;
  for (const Row& row : table.rows())
    numbers += row.kind == Row::Kind::kNumber || row.kind == Row::Kind::kInteger ? 1 : 0;
  EXPECT_EQ(numbers, fields.size() + others);
  for (const NumberField<Config>& field : fields) {
    const Row* row = table.find(field.name);
    ASSERT_NE(row, nullptr) << field.name;
    const Config usual = config;
    const double other = field.get(config) == row->range.high ? row->range.low : row->range.high;
    EXPECT_EQ(row->take(field.whole ? parameters::Value(static_cast<int>(other)) : parameters::Value(other)), "")
        << field.name;
    for (const NumberField<Config>& each : fields)
      EXPECT_EQ(each.get(config), each.name == field.name ? other : each.get(usual)) << field.name << ": " << each.name;
    config = usual;
  }
}

// The number is accepted at both ends of its range, and refused by its name just beyond them and when it is not finite.
template <class Config, class ErrorsOf>
void expectRange(const NumberField<Config>& field, double low, double high, const ErrorsOf& errors_of) {
  const auto is_refused = [&](double value) {
    Config config;
    field.set(config, value);
    return names(errors_of(config), field.name);
  };
  EXPECT_FALSE(is_refused(low)) << field.name << " = " << low;
  EXPECT_FALSE(is_refused(high)) << field.name << " = " << high;
  const double step = field.whole ? 1.0 : 1e-9 * std::max(std::abs(low), std::abs(high));
  EXPECT_TRUE(is_refused(low - step)) << field.name << " = " << low - step;
  EXPECT_TRUE(is_refused(high + step)) << field.name << " = " << high + step;
  if (field.whole) return;
  EXPECT_TRUE(is_refused(std::nan(""))) << field.name;
  EXPECT_TRUE(is_refused(std::numeric_limits<double>::infinity())) << field.name;
}

}  // namespace laparoscope_servo::test_support
