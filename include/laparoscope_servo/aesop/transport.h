// The serial port: opened for this process alone, raw, 8N1, without flow control. Never blocks.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

// What happened to which port, and what to do about it.
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
  // The port's driver hands bytes over at once; not every driver can be asked to.
  bool lowLatency() const;

  // What has come since the last call. Throws TransportError, and closes, when the line has gone.
  Bytes read();
  // Queues bytes and sends what the line takes at once. Throws TransportError, and closes, when the line has gone, or
  // when it has taken nothing for so long that what waits is no longer true.
  void write(const Bytes& bytes);
  // Waits until what was written has left, at most `seconds` (for the last word of a process that ends).
  void drain(double seconds);

 private:
  class Port;
  std::unique_ptr<Port> port_;
};

}  // namespace laparoscope_servo::aesop
