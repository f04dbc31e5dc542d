// A file that is there under its name only when it is whole.
//
// It is written beside its place, as NAME.partial, and renamed in the end: whoever reads NAME finds all of it, or what
// was there before. What is no regular file (a pipe, a terminal, /dev/null) is written to as it is.
#pragma once

#include <fstream>
#include <functional>
#include <ostream>
#include <string>

namespace laparoscope_servo {

class OutputFile {
 public:
  // Makes the file beside. Throws std::runtime_error, as keep() does: which file, and what the system says.
  // NAME.partial of an earlier run that was killed is overwritten. A link is followed: what it points to is replaced.
  explicit OutputFile(const std::string& name);
  // Takes away what was not kept.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& name() const { return name_; }
  // Where to write, by any means, until keep().
  const std::string& path() const { return path_; }
  // Once everything is written and closed: onto the disk, then under its name.
  void keep();

 private:
  std::string name_;
  std::string target_;  // name without links
  std::string path_;
  bool beside_ = false;
};

// The same as a stream for text.
class TextFile {
 public:
  explicit TextFile(const std::string& name);

  // Throws std::runtime_error as soon as it is known that something could not be written.
  void write(const std::function<void(std::ostream&)>& print);
  // Nothing is kept without it.
  void keep();

 private:
  void check();

  OutputFile file_;
  std::ofstream stream_;
};

// All at once.
void writeTextFile(const std::string& name, const std::function<void(std::ostream&)>& print);

}  // namespace laparoscope_servo
