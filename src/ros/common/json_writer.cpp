#include "ros/common/json_writer.h"

#include <cmath>

namespace laparoscope_servo {

void JsonWriter::beginObject(const std::string& name) {
  separate(name);
  out_ << '{';
  closing_ += '}';
  first_ = true;
}

void JsonWriter::beginArray(const std::string& name) {
  separate(name);
  out_ << '[';
  closing_ += ']';
  first_ = true;
}

void JsonWriter::end() {
  out_ << closing_.back();
  closing_.pop_back();
  first_ = false;
  if (closing_.empty()) out_ << '\n';
}

void JsonWriter::value(const std::string& name, double number) {
  separate(name);
  write(number);
}

void JsonWriter::value(const std::string& name, int number) {
  separate(name);
  out_ << number;
}

void JsonWriter::value(const std::string& name, bool truth) {
  separate(name);
  out_ << (truth ? "true" : "false");
}

void JsonWriter::value(const std::string& name, const std::string& text) {
  separate(name);
  write(text);
}

void JsonWriter::values(const std::string& name, const std::vector<double>& numbers) {
  beginArray(name);
  for (const double number : numbers) value("", number);
  end();
}

void JsonWriter::separate(const std::string& name) {
  if (!first_) out_ << ',';
  if (!closing_.empty() && closing_.back() == '}') {
    out_ << "\n" << std::string(closing_.size(), ' ');
    write(name);
    out_ << ": ";
  }
  first_ = false;
}

void JsonWriter::write(double number) {
  if (std::isfinite(number)) {
    out_ << number;
  } else {
    out_ << "null";
  }
}

void JsonWriter::write(const std::string& text) {
  out_ << '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') out_ << '\\';
    out_ << (static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
  }
  out_ << '"';
}

}  // namespace laparoscope_servo
