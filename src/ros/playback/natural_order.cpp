#include "ros/playback/natural_order.h"

#include <cctype>
#include <cstddef>

namespace laparoscope_servo {

namespace {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Takes the number at `at`, without leading zeros; moves `at` behind it.
std::string takeNumber(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t begin = at;
  while (at < text.size() && isDigit(text[at])) ++at;
  return text.substr(begin, at - begin);
}

}  // namespace

bool comesBefore(const std::string& left, const std::string& right) {
  std::size_t l = 0;
  std::size_t r = 0;
  while (l < left.size() && r < right.size()) {
    if (isDigit(left[l]) && isDigit(right[r])) {
      const std::string left_number = takeNumber(left, l);
      const std::string right_number = takeNumber(right, r);
      if (left_number.size() != right_number.size()) return left_number.size() < right_number.size();
      if (left_number != right_number) return left_number < right_number;
    } else {
      if (left[l] != right[r]) return static_cast<unsigned char>(left[l]) < static_cast<unsigned char>(right[r]);
      ++l;
      ++r;
    }
  }
  if (left.size() - l != right.size() - r) return left.size() - l < right.size() - r;
  return left.size() != right.size() ? left.size() < right.size() : left < right;
}

}  // namespace laparoscope_servo
