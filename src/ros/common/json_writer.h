// Writes JSON: objects and arrays nested by calls, numbers that are not finite as null.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace laparoscope_servo {

class JsonWriter {
 public:
  // `digits`: largest number of digits.
  explicit JsonWriter(std::ostream& out, int digits = 9) : out_(out) { out_.precision(digits); }

  // Inside an object every value has a name; inside an array the name is empty.
  void beginObject(const std::string& name = "");
  void beginArray(const std::string& name = "");
  void end();
  void value(const std::string& name, double number);
  void value(const std::string& name, int number);
  void value(const std::string& name, bool truth);
  void value(const std::string& name, const std::string& text);
  // otherwise it would convert to bool
  void value(const std::string& name, const char* text) { value(name, std::string(text)); }
  void values(const std::string& name, const std::vector<double>& numbers);

 private:
  void separate(const std::string& name);
  void write(double number);
  void write(const std::string& text);

  std::ostream& out_;
  std::string closing_;  // closing brackets of the open levels
  bool first_ = true;
};

}  // namespace laparoscope_servo
