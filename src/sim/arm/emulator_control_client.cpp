#include "laparoscope_servo/sim/emulator_control_client.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::sim {

namespace {

using boost::asio::local::stream_protocol;
using boost::system::error_code;

}  // namespace

class EmulatorControlClient::Connection {
 public:
  Connection(const std::string& path, double timeout) : path_(path), timeout_(timeout), socket_(context_) {
    try {
      socket_.connect(stream_protocol::endpoint(path));
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("control socket '" + path + "': " + error.code().message() +
                               "; is aesop_emulator running?");
    }
  }

  std::string ask(const std::string& line) {
    if (broken_) throw std::runtime_error("control socket '" + path_ + "' has failed before");
    const std::string bytes = line + "\n";
    error_code failure;
    bool done = false;
    boost::asio::async_write(socket_, boost::asio::buffer(bytes), [&](const error_code& write_error, std::size_t) {
      if (write_error) {
        failure = write_error;
        done = true;
        return;
      }
      boost::asio::async_read_until(socket_, boost::asio::dynamic_buffer(buffer_), '\n',
                                    [&](const error_code& read_error, std::size_t) {
                                      failure = read_error;
                                      done = true;
                                    });
    });
    context_.restart();
    context_.run_for(std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(timeout_)));
    if (!done) {
      broken_ = true;
      // The handlers refer to this stack frame, so they must end first.
      error_code ignored;
      socket_.close(ignored);
      context_.restart();
      context_.run();
      throw std::runtime_error("control socket '" + path_ + "': no answer to '" + line + "' in time");
    }
    if (failure) {
      broken_ = true;
      throw std::runtime_error("control socket '" + path_ + "': " + failure.message() + "; has aesop_emulator ended?");
    }
    const std::size_t end = buffer_.find('\n');
    const std::string answer = buffer_.substr(0, end);
    buffer_.erase(0, end + 1);
    return answer;
  }

 private:
  std::string path_;
  double timeout_;
  boost::asio::io_context context_;
  stream_protocol::socket socket_;
  std::string buffer_;
  bool broken_ = false;
};

EmulatorControlClient::EmulatorControlClient(const std::string& path, double timeout)
    : connection_(std::make_unique<Connection>(path, timeout)) {}

EmulatorControlClient::~EmulatorControlClient() = default;

std::string EmulatorControlClient::request(const std::string& line) {
  if (line.find('\n') != std::string::npos) throw std::runtime_error("a request is one line");
  const std::string answer = connection_->ask(line);
  if (answer == "ok") return "";
  if (answer.rfind("ok ", 0) == 0) return answer.substr(3);
  throw std::runtime_error("emulator, asked '" + line + "': " + answer);
}

EmulatorState EmulatorControlClient::state() {
  const std::string answer = request("state");
  std::istringstream stream(answer);
  EmulatorState state;
  stream >> state.time;
  for (int k = 0; k < aesop::kJoints; ++k) stream >> state.q[k];
  if (!stream) throw std::runtime_error("emulator, asked 'state': cannot read '" + answer + "'");
  return state;
}

EmulatorMotion EmulatorControlClient::motion() {
  const std::string answer = request("motion");
  std::istringstream stream(answer);
  EmulatorMotion motion;
  stream >> motion.state >> motion.moving >> motion.faults;
  for (int k = 0; k < aesop::kJoints; ++k) stream >> motion.qdot[k];
  if (!stream) throw std::runtime_error("emulator, asked 'motion': cannot read '" + answer + "'");
  return motion;
}

EmulatorRecord EmulatorControlClient::record() {
  const std::string answer = request("record");
  std::istringstream stream(answer);
  EmulatorRecord record;
  stream >> record.velocity_age >> record.motion_age >> record.longest_motion;
  if (!stream) throw std::runtime_error("emulator, asked 'record': cannot read '" + answer + "'");
  return record;
}

void EmulatorControlClient::hand(const scope::Velocity& displacement, double seconds) {
  std::ostringstream line;
  line << std::setprecision(12) << "hand " << displacement.pan << ' ' << displacement.tilt << ' ' << displacement.spin
       << ' ' << displacement.insertion << ' ' << seconds;
  request(line.str());
}

void EmulatorControlClient::fault(const std::string& name, double value) {
  std::ostringstream line;
  line << std::setprecision(12) << "fault " << name << ' ' << value;
  request(line.str());
}

}  // namespace laparoscope_servo::sim
