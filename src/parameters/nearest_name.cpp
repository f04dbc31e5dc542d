#include "laparoscope_servo/parameters/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace laparoscope_servo::parameters {

namespace {

// Insertions, deletions and replacements that make one of the other (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearestName(const std::set<std::string>& known, const std::string& path) {
  constexpr std::size_t kSlips = 2;
  const auto last = [](const std::string& whole) { return whole.substr(whole.rfind('/') + 1); };
  std::string nearest;
  std::size_t least = path.size();
  for (const std::string& name : known) {
    const std::size_t longer = std::max(name.size(), path.size()) - std::min(name.size(), path.size());
    if (longer > kSlips && last(name) != last(path)) continue;
    const std::size_t distance = editDistance(path, name);
    if (distance >= least || (distance > kSlips && last(name) != last(path))) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

}  // namespace laparoscope_servo::parameters
