#include "laparoscope_servo/aesop/transport.h"

#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <thread>

namespace laparoscope_servo::aesop {

namespace {

using boost::asio::serial_port;
using boost::system::error_code;

constexpr std::size_t kLargestBacklog = 1024;  // bytes, a quarter of a second at 38,400 baud

std::string cure(int error, const std::string& port) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "there is no such port; is the cable plugged in, is the name right?";
    case EACCES:
    case EPERM:
      return "permission denied; add this user to the group that owns " + port + " (often 'dialout') and log in again";
    case ENOTTY:
    case EISDIR:
    case EINVAL:
      return "it is no serial port; a terminal such as /dev/ttyUSB0 is expected";
    case EBUSY:
    case EWOULDBLOCK:
      return "it is in use by another process; stop that one first ('fuser -v " + port + "' names it)";
    default:
      return std::strerror(error);
  }
}

[[noreturn]] void fail(const std::string& port, int error) {
  throw TransportError("port '" + port + "': " + cure(error, port));
}

}  // namespace

class SerialTransport::Port {
 public:
  Port(const std::string& name, int baud_rate) : name_(name), port_(context_) {
    error_code error;
    port_.open(name, error);
    if (error) fail(name_, error.value());
    if (::isatty(port_.native_handle()) == 0) fail(name_, ENOTTY);
    // The lock keeps out other processes of this package, also as root; TIOCEXCL keeps out all others.
    if (::flock(port_.native_handle(), LOCK_EX | LOCK_NB) != 0) fail(name_, errno);
    if (::ioctl(port_.native_handle(), TIOCEXCL) != 0) fail(name_, errno);
    exclusive_ = true;
    try {
      port_.set_option(serial_port::baud_rate(static_cast<unsigned>(baud_rate)));
      port_.set_option(serial_port::character_size(8));
      port_.set_option(serial_port::parity(serial_port::parity::none));
      port_.set_option(serial_port::stop_bits(serial_port::stop_bits::one));
      port_.set_option(serial_port::flow_control(serial_port::flow_control::none));
    } catch (const boost::system::system_error& refused) {
      release();
      throw TransportError("port '" + name_ + "': it refuses " + std::to_string(baud_rate) +
                           " baud, 8N1, no flow control: " + refused.code().message());
    }
    low_latency_ = askForLowLatency();
    ::tcflush(port_.native_handle(), TCIOFLUSH);  // drops bytes that belong to another process
    listen();
  }

  ~Port() { release(); }

  bool lowLatency() const { return low_latency_; }

  Bytes read() {
    run();
    Bytes bytes;
    bytes.swap(received_);
    return bytes;
  }

  void write(const Bytes& bytes) {
    run();
    if (waiting_.size() + bytes.size() > kLargestBacklog) {
      throw TransportError("port '" + name_ +
                           "': the line takes no bytes; is the controller running, the cable whole?");
    }
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    send();
    run();
  }

  void drain(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      run();
      int queued = 0;
      if (waiting_.empty() && !sending_ && ::ioctl(port_.native_handle(), TIOCOUTQ, &queued) == 0 && queued == 0)
        return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

 private:
  // Makes the driver pass on bytes as they come instead of after a timer of the adapter (16 ms in FTDI's). A pty and
  // many drivers have no such setting.
  bool askForLowLatency() {
    serial_struct settings{};
    if (::ioctl(port_.native_handle(), TIOCGSERIAL, &settings) != 0) return false;
    settings.flags |= ASYNC_LOW_LATENCY;
    return ::ioctl(port_.native_handle(), TIOCSSERIAL, &settings) == 0;
  }

  void listen() {
    port_.async_read_some(boost::asio::buffer(incoming_), [this](const error_code& error, std::size_t count) {
      if (error) {
        gone_ = error;
        return;
      }
      received_.insert(received_.end(), incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(count));
      listen();
    });
  }

  void send() {
    if (sending_ || waiting_.empty()) return;
    sending_ = true;
    outgoing_.assign(waiting_.begin(), waiting_.end());
    port_.async_write_some(boost::asio::buffer(outgoing_), [this](const error_code& error, std::size_t count) {
      sending_ = false;
      if (error) {
        gone_ = error;
        return;
      }
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
      send();
    });
  }

  void run() {
    context_.restart();
    context_.poll();
    if (gone_) {
      throw TransportError("port '" + name_ + "': the line has gone (" + gone_.message() +
                           "); is the cable unplugged, the adapter off?");
    }
  }

  void release() {
    if (!port_.is_open()) return;
    if (exclusive_) ::ioctl(port_.native_handle(), TIOCNXCL);
    ::tcflush(port_.native_handle(), TCOFLUSH);  // otherwise closing may wait half a minute for a blocked line
    error_code ignored;                          // closing a line that is gone returns an error
    port_.close(ignored);
  }

  std::string name_;
  boost::asio::io_context context_;
  serial_port port_;
  bool exclusive_ = false;
  bool low_latency_ = false;
  std::array<std::uint8_t, 512> incoming_{};
  Bytes received_;
  std::deque<std::uint8_t> waiting_;
  Bytes outgoing_;
  bool sending_ = false;
  error_code gone_;
};

SerialTransport::SerialTransport() = default;
SerialTransport::~SerialTransport() = default;

void SerialTransport::open(const std::string& port, int baud_rate) {
  port_.reset();
  try {
    port_ = std::make_unique<Port>(port, baud_rate);
  } catch (const boost::system::system_error& error) {  // for example if no descriptors are left
    throw TransportError("port '" + port + "': it cannot be opened: " + error.what());
  }
}

void SerialTransport::close() {
  port_.reset();
}
bool SerialTransport::isOpen() const {
  return port_ != nullptr;
}

bool SerialTransport::lowLatency() const {
  return port_ && port_->lowLatency();
}

Bytes SerialTransport::read() {
  if (!port_) return {};
  try {
    return port_->read();
  } catch (const TransportError&) {
    close();
    throw;
  }
}

void SerialTransport::write(const Bytes& bytes) {
  if (!port_ || bytes.empty()) return;
  try {
    port_->write(bytes);
  } catch (const TransportError&) {
    close();
    throw;
  }
}

void SerialTransport::drain(double seconds) {
  if (port_) port_->drain(seconds);
}

}  // namespace laparoscope_servo::aesop
