// The serial port: opened exclusively, raw, 8N1, without flow control. Never blocks.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

// An error of a port, with what to do about it.
class TransportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class SerialTransport {
 public:
  SerialTransport();
  ~SerialTransport();
  SerialTransport(const SerialTransport&) = delete;
  SerialTransport& operator=(const SerialTransport&) = delete;

  // Throws TransportError: no such port, no permission, not a terminal, in use, a baud rate that it does not have.
  void open(const std::string& port, int baud_rate);
  void close();
  bool isOpen() const;
  // Whether the port's driver passes bytes on at once; not every driver has that setting.
  bool lowLatency() const;

  // The bytes received since the last call. Throws TransportError, and closes, if the line is gone.
  Bytes read();
  // Queues bytes and sends as many as the line accepts. Throws TransportError, and closes, if the line is gone, or if
  // so many bytes wait that they are out of date.
  void write(const Bytes& bytes);
  // Waits until all written bytes are sent, at most `seconds` (for the last message of a process that ends).
  void drain(double seconds);

 private:
  class Port;
  std::unique_ptr<Port> port_;
};

}  // namespace laparoscope_servo::aesop
