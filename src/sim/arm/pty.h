// A pseudo-terminal with a symbolic link to its far end: the serial port of the emulated robot.
#pragma once

#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::sim {

class Pty {
 public:
  // `link`: path of the symbolic link. An old link is replaced; for any other file std::runtime_error is thrown.
  explicit Pty(const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  // Never block; bytes that the far end does not take are lost, as on a serial line.
  aesop::Bytes read();
  void write(const aesop::Bytes& bytes);
  // A second descriptor of this end, for polling; the caller closes it. Throws std::runtime_error.
  int duplicate() const;
  // Allows opening the port again after a process that opened it exclusively was killed; for a real port the kernel
  // does so.
  void release();

  // The device itself, e.g. /dev/pts/3.
  const std::string& device() const { return device_; }

 private:
  void close();

  std::string link_;
  std::string device_;
  int master_ = -1;
  int slave_ = -1;  // held open, so that the settings and bytes of the line survive each client
};

}  // namespace laparoscope_servo::sim
