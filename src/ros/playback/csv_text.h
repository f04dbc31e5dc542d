// Values as the tables of the offline tool have them.
#pragma once

#include <cstdio>
#include <string>

namespace laparoscope_servo {

// 17 digits, so that it reads back as the same double.
inline std::string exact(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

// Quoted by RFC 4180, so that a comma or a quote in the text does not end the field.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace laparoscope_servo
