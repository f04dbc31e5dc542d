// A recording of all input and output of the driver, in a compact binary form: doc/wire_log.md describes it byte by
// byte. The driver can be run again from it, bit for bit (wire_replay.h).
//
// Pure: converts records to bytes, and a stream to records.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <istream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

enum class WireEvent : std::uint8_t {
  kOpened = 1,           // the port
  kClosed = 2,           // the port; text: why
  kReceived = 3,         // bytes from the controller
  kSent = 4,             // a cycle of the driver; bytes to the controller, often none
  kEnable = 5,           // asked for; number: stamp_now
  kDisable = 6,          // requested; text: why, empty for a service call
  kClearFault = 7,       // asked for
  kPause = 8,            // asked for; text: why
  kResume = 9,           // asked for; number: stamp_now
  kCommand = 10,         // numbers: pan, tilt, spin, insertion, stamp, stamp_now
  kState = 11,           // new state at the end of a cycle: mode, flags, text
  kInsertionPoint = 12,  // changed; numbers: x, y, z [m]
};

struct WireRecord {
  WireEvent event = WireEvent::kSent;
  std::int64_t time = 0;  // ns, on the driver's steady clock
  Bytes payload;
};

// Payloads of numbers. numbersOf throws std::invalid_argument unless there are `count`.
Bytes payloadOf(std::initializer_list<double> numbers);
Bytes payloadOf(const std::string& text);
std::vector<double> numbersOf(const WireRecord& record, std::size_t count);
std::string textOf(const WireRecord& record);

// Receives all input and output of a driver.
class WireTap {
 public:
  virtual ~WireTap() = default;
  virtual void take(const WireRecord& record) = 0;
};

struct WireLogHeader {
  std::int64_t wall_time = 0;  // us since 1970, UTC, at `time`; 0: not known
  std::int64_t time = 0;       // ns, of the steady clock
  std::string codec;           // its name(), of at most 255 characters
};

class WireLogEncoder {
 public:
  void begin(const WireLogHeader& header, Bytes& bytes);
  void add(const WireRecord& record, Bytes& bytes);

 private:
  std::int64_t time_ = 0;
};

// Text with the offset at which the file is not a valid recording.
class WireLogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class WireLogReader {
 public:
  // Reads the header. Throws WireLogError. `stream` must outlive the reader.
  explicit WireLogReader(std::istream& stream);

  const WireLogHeader& header() const { return header_; }
  // The next record, or nothing at the end. Throws WireLogError.
  std::optional<WireRecord> next();
  // Whether the file ends within a record, as it does when the writer was killed.
  bool truncated() const { return truncated_; }

 private:
  std::optional<std::uint8_t> byte();
  std::optional<std::uint64_t> varint();
  bool read(Bytes& bytes, std::size_t size);
  [[noreturn]] void fail(const std::string& what) const;

  std::istream& stream_;
  WireLogHeader header_;
  std::uint64_t offset_ = 0;
  std::int64_t time_ = 0;
  bool truncated_ = false;
};

}  // namespace laparoscope_servo::aesop
