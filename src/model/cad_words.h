// The words of a .cao file with their lines, and what is wrong with them.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace laparoscope_servo::model {

class CadWords {
 public:
  CadWords(std::istream& stream, std::string name);

  // The next word, or "" at the end.
  const std::string& peek() const;
  std::string next(const std::string& expected);
  // Finite.
  double number(const std::string& expected);
  // From `least` to `most`.
  int integer(int least, int most, const std::string& expected);
  // Throws CadFileError of the word that was read last.
  [[noreturn]] void refuse(const std::string& expected) const;
  // The same of something that is made of several words.
  [[noreturn]] void refuse(const std::string& value, const std::string& expected) const;

 private:
  struct Word {
    std::string text;
    int line = 0;
  };
  [[noreturn]] void fail(int line, const std::string& value, const std::string& expected) const;

  std::string name_;
  std::vector<Word> words_;
  std::size_t at_ = 0;
  int lines_ = 0;
};

}  // namespace laparoscope_servo::model
