// A file that gets its name only when it is complete.
//
// It is written as NAME.partial and renamed at the end, so that readers of NAME find the complete file or the old one.
// Special files (a pipe, a terminal, /dev/null) are written directly.
#pragma once

#include <fstream>
#include <functional>
#include <ostream>
#include <string>

namespace laparoscope_servo {

class OutputFile {
 public:
  // Creates NAME.partial. Throws std::runtime_error, as keep() does, with the file and the system's error. A
  // NAME.partial of an earlier run that was killed is overwritten. Links are followed: their target is replaced.
  explicit OutputFile(const std::string& name);
  // Deletes NAME.partial unless keep() was called.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& name() const { return name_; }
  // The file to write to until keep().
  const std::string& path() const { return path_; }
  // Call when everything is written and closed: flushes it to the disk and renames it.
  void keep();

 private:
  std::string name_;
  std::string target_;  // the name with links resolved
  std::string path_;
  bool beside_ = false;
};

// OutputFile for text, with a stream.
class TextFile {
 public:
  explicit TextFile(const std::string& name);

  // Throws std::runtime_error as soon as an error of writing is known.
  void write(const std::function<void(std::ostream&)>& print);
  // Without this call the file is deleted.
  void keep();

 private:
  void check();

  OutputFile file_;
  std::ofstream stream_;
};

// Writes and keeps a text file in one call.
void writeTextFile(const std::string& name, const std::function<void(std::ostream&)>& print);

}  // namespace laparoscope_servo
