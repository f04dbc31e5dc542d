#include "ros/common/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what, int error) {
  throw std::runtime_error("'" + name + "' cannot be written: " + what +
                           (error != 0 ? std::string(": ") + std::strerror(error) : ""));
}

// Resolves links; the target need not exist.
std::string withoutLinks(const std::string& name) {
  std::filesystem::path path = name;
  for (int links = 0; links < 40; ++links) {  // the kernel's own limit
    std::error_code error;
    const std::filesystem::path to = std::filesystem::read_symlink(path, error);
    if (error) return path.string();
    path = path.parent_path() / to;  // an absolute path replaces the folder
  }
  fail(name, "links that lead in a circle", 0);
}

class Descriptor {
 public:
  Descriptor(const std::string& path, int flags, mode_t mode) : value_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

}  // namespace

OutputFile::OutputFile(const std::string& name) : name_(name), target_(withoutLinks(name)), path_(target_) {
  struct stat existing {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode)) fail(name_, "it is a folder", 0);
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(name_, "open", errno);
  if (exists && !S_ISREG(existing.st_mode)) return;
  path_ = target_ + ".partial";
  // 0666 without the user's mask, as for any new file; a replaced file keeps its permissions.
  const Descriptor file(path_, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file.value() < 0) fail(name_, "open of '" + path_ + "'", errno);
  beside_ = true;
  if (exists) static_cast<void>(::fchmod(file.value(), existing.st_mode & 07777));
}

OutputFile::~OutputFile() {
  if (beside_) ::unlink(path_.c_str());
}

void OutputFile::keep() {
  if (!beside_) return;
  {
    // fsync: reports errors of delayed writing, and makes sure that the name does not lead to an empty file after a
    // power cut.
    const Descriptor file(path_, O_WRONLY, 0);
    if (file.value() < 0 || ::fsync(file.value()) != 0) fail(name_, "fsync", errno);
  }
  if (std::rename(path_.c_str(), target_.c_str()) != 0) fail(name_, "rename", errno);
  beside_ = false;
}

TextFile::TextFile(const std::string& name) : file_(name) {
  errno = 0;
  stream_.open(file_.path(), std::ios::trunc);
  check();
}

void TextFile::check() {
  if (!stream_) fail(file_.name(), "write", errno);
}

void TextFile::write(const std::function<void(std::ostream&)>& print) {
  errno = 0;
  print(stream_);
  check();
}

void TextFile::keep() {
  errno = 0;
  stream_.close();
  check();
  file_.keep();
}

void writeTextFile(const std::string& name, const std::function<void(std::ostream&)>& print) {
  TextFile file(name);
  file.write(print);
  file.keep();
}

}  // namespace laparoscope_servo
