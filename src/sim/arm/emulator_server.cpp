#include "laparoscope_servo/sim/emulator_server.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <functional>
#include <stdexcept>

#include "laparoscope_servo/sim/emulator_control.h"
#include "sim/arm/pty.h"

namespace laparoscope_servo::sim {

namespace {

namespace posix = boost::asio::posix;
using boost::asio::local::stream_protocol;
using boost::system::error_code;

constexpr std::size_t kLongestRequest = 256;  // bytes
constexpr double kSilence = 1.0;              // s without a byte from the host, after which its process may be gone
constexpr double kLongestPause = 0.005;       // s, longest time between two cycles
constexpr double kShortestPause = 0.001;      // s: bytes that arrive closer together are passed on together
constexpr std::chrono::milliseconds kStopPeriod{20};

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::chrono::steady_clock::time_point steadyTime(double seconds) {
  return std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds)));
}

using Answer = std::function<std::string(const std::string&)>;

// One client of the control socket; lives as long as its handlers do.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(stream_protocol::socket socket, const Answer& answer) : socket_(std::move(socket)), answer_(answer) {}

  void listen() {
    boost::asio::async_read_until(socket_, boost::asio::dynamic_buffer(buffer_, kLongestRequest), '\n',
                                  [self = shared_from_this()](const error_code& error, std::size_t count) {
                                    if (!error) self->reply(count);
                                  });
  }

 private:
  void reply(std::size_t count) {
    const std::string line = buffer_.substr(0, count - 1);
    buffer_.erase(0, count);
    reply_ = answer_(line) + "\n";
    boost::asio::async_write(socket_, boost::asio::buffer(reply_),
                             [self = shared_from_this()](const error_code& error, std::size_t) {
                               if (!error) self->listen();
                             });
  }

  stream_protocol::socket socket_;
  Answer answer_;
  std::string buffer_;
  std::string reply_;
};

}  // namespace

class EmulatorServer::Loop {
 public:
  Loop(const EmulatorConfig& config, const ServerConfig& server)
      : emulator_(config, steadyNow()),
        wire_(server.seed, server.baud_rate),
        faults_(emulator_, wire_),
        link_(server.link),
        control_(server.control),
        acceptor_(context_),
        port_events_(context_),
        timer_(context_) {
    openPort();
    device_ = pty_->device();
    if (!control_.empty()) openControl();
    const double now = steadyNow();
    for (const ScheduledFault& fault : server.script) {
      const std::string error = faults_.schedule(fault, now);
      if (!error.empty()) throw std::invalid_argument("script: " + error);
    }
  }

  ~Loop() {
    if (acceptor_.is_open()) ::unlink(control_.c_str());
  }

  void run(const std::atomic<bool>& stop) {
    turn();
    while (!stop) context_.run_for(kStopPeriod);
  }

  const std::string& device() const { return device_; }

 private:
  void openControl() {
    struct stat existing {};
    if (::lstat(control_.c_str(), &existing) == 0) {
      if (!S_ISSOCK(existing.st_mode)) {
        throw std::runtime_error("'" + control_ +
                                 "' exists and is no socket, expected a free name for the control socket");
      }
      ::unlink(control_.c_str());
    }
    try {
      acceptor_.open();
      acceptor_.bind(stream_protocol::endpoint(control_));
      // Restricted, since write access allows moving the arm by hand.
      if (::chmod(control_.c_str(), S_IRUSR | S_IWUSR) != 0) throw std::runtime_error("control socket: chmod failed");
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("control socket '" + control_ + "': " + error.code().message());
    }
    accept();
  }

  void accept() {
    acceptor_.async_accept([this](const error_code& error, stream_protocol::socket socket) {
      if (!error) {
        const auto answer = [this](const std::string& line) {
          const std::string text = answerControl(line, emulator_, faults_, steadyNow());
          turn();
          return text;
        };
        std::make_shared<Client>(std::move(socket), answer)->listen();
      }
      accept();
    });
  }

  void openPort() {
    pty_ = std::make_unique<Pty>(link_);
    port_events_.assign(pty_->duplicate());
    listen();
  }

  // Closes the duplicate too, otherwise the far end would not notice that the port is gone.
  void closePort() {
    port_events_.close();
    pty_.reset();
  }

  void listen() {
    port_events_.async_wait(posix::stream_descriptor::wait_read, [this](const error_code& error) {
      if (error) return;
      turn();
      if (pty_) listen();
    });
  }

  void turn() {
    const double now = steadyNow();
    faults_.step(now);
    if (wire_.isCut(now) && pty_) closePort();
    if (!wire_.isCut(now) && !pty_) openPort();
    if (pty_) {
      const aesop::Bytes requests = pty_->read();
      if (!requests.empty()) heard_ = now;
      if (now - heard_ > kSilence) pty_->release();
      wire_.to_controller.push(requests, now);
    }
    const aesop::Bytes arrived = wire_.to_controller.pop(now);
    wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now), now);
    const aesop::Bytes replies = wire_.to_host.pop(now);
    if (pty_ && !replies.empty()) pty_->write(replies);
    wait(now);
  }

  void wait(double now) {
    const double next = std::min({now + kLongestPause, std::max(now + kShortestPause, wire_.next()), faults_.next()});
    timer_.expires_at(steadyTime(next));
    timer_.async_wait([this](const error_code& error) {
      if (!error) turn();
    });
  }

  Emulator emulator_;
  Wire wire_;
  Faults faults_;
  std::string link_;
  std::string control_;
  std::string device_;
  boost::asio::io_context context_;
  stream_protocol::acceptor acceptor_;
  posix::stream_descriptor port_events_;
  boost::asio::steady_timer timer_;
  std::unique_ptr<Pty> pty_;
  double heard_ = 0.0;
};

EmulatorServer::EmulatorServer(const EmulatorConfig& config, const ServerConfig& server)
    : loop_(std::make_unique<Loop>(config, server)) {}

EmulatorServer::~EmulatorServer() = default;

void EmulatorServer::run(const std::atomic<bool>& stop) {
  loop_->run(stop);
}

const std::string& EmulatorServer::device() const {
  return loop_->device();
}

}  // namespace laparoscope_servo::sim
