#include "model/cad_words.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "laparoscope_servo/model/cad_model.h"

namespace laparoscope_servo::model {

namespace {

constexpr std::size_t kLongest = 60;  // characters that an error shows: a file of another kind may have no words

std::string shown(const std::string& value) {
  std::string text = value.substr(0, kLongest);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text + (value.size() > kLongest ? "..." : "");
}

}  // namespace

CadWords::CadWords(std::istream& stream, std::string name) : name_(std::move(name)) {
  std::string line;
  while (std::getline(stream, line)) {
    ++lines_;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    while (words >> word) words_.push_back({word, lines_});
  }
}

const std::string& CadWords::peek() const {
  static const std::string kEnd;
  return at_ < words_.size() ? words_[at_].text : kEnd;
}

std::string CadWords::next(const std::string& expected) {
  if (at_ == words_.size()) fail(lines_, "the file ends", expected);
  return words_[at_++].text;
}

double CadWords::number(const std::string& expected) {
  const std::string text = next(expected);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value)) refuse(expected);
  return value;
}

int CadWords::integer(int least, int most, const std::string& expected) {
  const std::string text = next(expected);
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (*end != '\0' || errno != 0 || value < least || value > most) {
    refuse(expected + ", a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return static_cast<int>(value);
}

void CadWords::refuse(const std::string& expected) const {
  refuse(words_[at_ - 1].text, expected);
}

void CadWords::refuse(const std::string& value, const std::string& expected) const {
  fail(at_ > 0 ? words_[at_ - 1].line : lines_, value, expected);
}

void CadWords::fail(int line, const std::string& value, const std::string& expected) const {
  throw CadFileError(name_ + ", line " + std::to_string(line) + ": " + shown(value) + ", expected " + expected);
}

}  // namespace laparoscope_servo::model
