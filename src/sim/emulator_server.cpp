#include "laparoscope_servo/sim/emulator_server.h"

#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <functional>
#include <stdexcept>

#include "laparoscope_servo/sim/emulator_control.h"
#include "laparoscope_servo/sim/pty.h"

namespace laparoscope_servo::sim {

namespace {

using boost::asio::local::stream_protocol;
using boost::system::error_code;

constexpr std::size_t kLongestRequest = 256;  // bytes
constexpr double kSilence = 1.0;              // s without a byte from the host: its process may have gone
constexpr std::chrono::milliseconds kTick{2};

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
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
  Loop(const EmulatorConfig& config, const std::string& link, const std::string& control, std::uint32_t seed)
      : emulator_(config, steadyNow()), wire_(seed), link_(link), control_(control), acceptor_(context_) {
    pty_ = std::make_unique<Pty>(link_);
    device_ = pty_->device();
    if (!control_.empty()) openControl();
  }

  ~Loop() {
    if (acceptor_.is_open()) ::unlink(control_.c_str());
  }

  void run(const std::atomic<bool>& stop) {
    while (!stop) {
      context_.restart();
      context_.run_for(kTick);
      if (control_.empty()) ::usleep(static_cast<useconds_t>(std::chrono::microseconds(kTick).count()));
      turn(steadyNow());
    }
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
      // Whoever may write to it moves the arm by hand.
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
          return answerControl(line, emulator_, wire_, steadyNow());
        };
        std::make_shared<Client>(std::move(socket), answer)->listen();
      }
      accept();
    });
  }

  void turn(double now) {
    if (wire_.isCut(now)) {
      pty_.reset();
    } else if (!pty_) {
      pty_ = std::make_unique<Pty>(link_);
    }
    if (pty_) {
      const aesop::Bytes requests = pty_->read();
      if (!requests.empty()) heard_ = now;
      if (now - heard_ > kSilence) pty_->release();
      wire_.to_controller.push(requests, wire_.faults, now);
    }
    const aesop::Bytes arrived = wire_.to_controller.pop(now);
    wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now), wire_.faults, now);
    const aesop::Bytes replies = wire_.to_host.pop(now);
    if (pty_ && !replies.empty()) pty_->write(replies);
  }

  Emulator emulator_;
  Wire wire_;
  std::string link_;
  std::string control_;
  std::string device_;
  boost::asio::io_context context_;
  stream_protocol::acceptor acceptor_;
  std::unique_ptr<Pty> pty_;
  double heard_ = 0.0;
};

EmulatorServer::EmulatorServer(const EmulatorConfig& config, const std::string& link, const std::string& control,
                               std::uint32_t seed)
    : loop_(std::make_unique<Loop>(config, link, control, seed)) {}

EmulatorServer::~EmulatorServer() = default;

void EmulatorServer::run(const std::atomic<bool>& stop) {
  loop_->run(stop);
}

const std::string& EmulatorServer::device() const {
  return loop_->device();
}

}  // namespace laparoscope_servo::sim
