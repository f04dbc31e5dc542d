// The worked examples of doc/aesop_protocol.md, and bytes written as text.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::test_support {

// "A5 5A # comment" and so on.
inline aesop::Bytes bytesOf(const std::string& text) {
  aesop::Bytes bytes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

// By name: a line that begins with "Example `name`", then lines of bytes, indented by four.
inline std::map<std::string, aesop::Bytes> pageExamples(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read '" + path + "'");
  std::map<std::string, std::string> texts;
  std::string name;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("Example `", 0) == 0) {
      name = line.substr(9, line.find('`', 9) - 9);
    } else if (!name.empty() && line.rfind("    ", 0) == 0) {
      texts[name] += line + "\n";
    } else if (line.rfind('#', 0) == 0) {
      name.clear();
    }
  }
  std::map<std::string, aesop::Bytes> examples;
  for (const auto& [example, text] : texts) examples[example] = bytesOf(text);
  return examples;
}

}  // namespace laparoscope_servo::test_support
