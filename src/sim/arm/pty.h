// A pseudo-terminal with a symbolic link to its far end: the serial port of a robot that is not there.
#pragma once

#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::sim {

class Pty {
 public:
  // `link`: where to put the symbolic link; an old link is replaced, anything else there is left alone and refused.
  // Throws std::runtime_error.
  explicit Pty(const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  // Never block; what the far end does not take is lost, as on a serial line.
  aesop::Bytes read();
  void write(const aesop::Bytes& bytes);
  // A descriptor of this end for somebody who watches it, and closes it. Throws std::runtime_error.
  int duplicate() const;
  // Lets somebody else open the port after a process that opened it exclusively was killed: with a real port the kernel
  // does so.
  void release();

  // The device itself, e.g. /dev/pts/3.
  const std::string& device() const { return device_; }

 private:
  void close();

  std::string link_;
  std::string device_;
  int master_ = -1;
  int slave_ = -1;  // held open, or the settings and bytes of the line would end with each client
};

}  // namespace laparoscope_servo::sim
