#include "ros/common/master_client.h"

#include <XmlRpcException.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "ros/common/clocks.h"

namespace laparoscope_servo {

namespace {

using Outcome = MasterClient::Outcome;

constexpr double kSlice = 0.05;  // s, period for checking `ending`
constexpr const char* kNoMaster = "it is no ROS master that answers";
constexpr std::size_t kLongestAnswer = 65536;  // bytes; answers to the calls made here are below a thousand

struct Adopt {};
constexpr Adopt adopt;

class Socket {
 public:
  Socket(Adopt, int file) : file_(file) {}
  explicit Socket(int family) : file_(::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (file_ >= 0) ::close(file_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int file() const { return file_; }
  int release() { return std::exchange(file_, -1); }

 private:
  int file_;
};

// Checks the socket once more at the end, so that a delay of this thread is not taken for one of the master.
bool waitUntilReady(int file, short events, double deadline, const std::atomic<bool>& ending) {
  while (true) {
    const double left = std::max(0.0, deadline - steadyNow());
    pollfd entry{file, events, 0};
    const int ready = ::poll(&entry, 1, static_cast<int>(1000.0 * std::min(left, kSlice)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
    if ((ready == 0 && left == 0.0) || ending) return false;
  }
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

std::string request(const std::string& address, const std::string& method, const std::vector<std::string>& arguments) {
  std::string body = "<?xml version=\"1.0\"?>\n<methodCall><methodName>" + method + "</methodName><params>";
  for (const std::string& argument : arguments)
    body += "<param><value><string>" + escaped(argument) + "</string></value></param>";
  body += "</params></methodCall>\n";
  return "POST /RPC2 HTTP/1.0\r\nHost: " + address + "\r\nConnection: close\r\nContent-Type: text/xml\r\n" +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

// Takes the body of a complete HTTP answer; false while it is incomplete.
bool takeBody(const std::string& answer, std::string& body) {
  const std::size_t head = answer.find("\r\n\r\n");
  if (head == std::string::npos) return false;
  std::string fields = answer.substr(0, head);
  std::transform(fields.begin(), fields.end(), fields.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string key = "content-length:";
  const std::size_t at = fields.find(key);
  if (at == std::string::npos) return false;
  const std::size_t length = std::strtoul(fields.c_str() + at + key.size(), nullptr, 10);
  if (answer.size() < head + 4 + length) return false;
  body = answer.substr(head + 4, length);
  return true;
}

// Parses <methodResponse><params><param><value>...; false if it is something else.
bool parse(const std::string& body, XmlRpc::XmlRpcValue& result) {
  const std::size_t at = body.find("<value>");
  if (at == std::string::npos || body.find("<fault>") != std::string::npos) return false;
  try {
    int offset = static_cast<int>(at);
    return result.fromXml(body, &offset) && result.getType() == XmlRpc::XmlRpcValue::TypeArray && result.size() == 3 &&
           result[0].getType() == XmlRpc::XmlRpcValue::TypeInt;
  } catch (const XmlRpc::XmlRpcException&) {
    return false;
  }
}

}  // namespace

MasterClient::MasterClient(const std::string& host, std::uint32_t port)
    : host_(host), port_(port), address_(host + ":" + std::to_string(port)) {}

void MasterClient::lookUp() {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host_.c_str(), std::to_string(port_).c_str(), &hints, &found) != 0) return;
  // IPv4 first, as in roscpp.
  for (const int family : {AF_INET, AF_INET6}) {
    for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
      if (entry->ai_family != family) continue;
      peers_.emplace_back();
      std::memcpy(&peers_.back(), entry->ai_addr, entry->ai_addrlen);
      sizes_.push_back(entry->ai_addrlen);
    }
  }
  ::freeaddrinfo(found);
}

Outcome MasterClient::fail(Outcome outcome, const std::string& problem) {
  problem_ = problem;
  return outcome;
}

// Connects to the first address that accepts. `file` is open only for kAnswered.
Outcome MasterClient::open(double deadline, const std::atomic<bool>& ending, int& file) {
  if (peers_.empty()) lookUp();
  if (peers_.empty()) return fail(Outcome::kSilent, "its address is not known");
  Outcome outcome = Outcome::kRefused;
  for (std::size_t k = 0; k < peers_.size(); ++k) {
    Socket socket(peers_[k].ss_family);
    if (socket.file() < 0) return fail(Outcome::kSilent, std::string("no socket: ") + std::strerror(errno));
    int error = ::connect(socket.file(), reinterpret_cast<const sockaddr*>(&peers_[k]), sizes_[k]) == 0 ? 0 : errno;
    if (error == EADDRNOTAVAIL || error == EAGAIN) return fail(Outcome::kSilent, std::strerror(error));
    if (error == EINPROGRESS) {
      if (!waitUntilReady(socket.file(), POLLOUT, deadline, ending)) return fail(Outcome::kSilent, "no connection");
      socklen_t size = sizeof(error);
      ::getsockopt(socket.file(), SOL_SOCKET, SO_ERROR, &error, &size);
    }
    if (error == 0) {
      file = socket.release();
      return Outcome::kAnswered;
    }
    outcome = fail(Outcome::kRefused, std::strerror(error));
  }
  return outcome;
}

Outcome MasterClient::exchange(int file, const std::string& question, double deadline, const std::atomic<bool>& ending,
                               std::string& body) {
  // Short enough to fit into an empty buffer as a whole.
  if (::send(file, question.data(), question.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(question.size()))
    return fail(Outcome::kRefused, std::strerror(errno));
  std::string answer;
  while (!takeBody(answer, body)) {
    if (!waitUntilReady(file, POLLIN, deadline, ending)) return fail(Outcome::kSilent, "no answer");
    char buffer[4096];
    const ssize_t count = ::recv(file, buffer, sizeof(buffer), 0);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count < 0) return fail(Outcome::kRefused, std::strerror(errno));
    if (count == 0 && answer.empty()) return fail(Outcome::kRefused, "the connection was closed without an answer");
    answer.append(buffer, static_cast<std::size_t>(count));
    if (count == 0 || answer.size() > kLongestAnswer) return fail(Outcome::kNonsense, kNoMaster);
  }
  return Outcome::kAnswered;
}

Outcome MasterClient::call(const std::string& method, const std::vector<std::string>& arguments, double patience,
                           const std::atomic<bool>& ending, XmlRpc::XmlRpcValue& result) {
  const double deadline = steadyNow() + patience;
  int file = -1;
  Outcome outcome = open(deadline, ending, file);
  if (outcome != Outcome::kAnswered) return outcome;
  const Socket socket(adopt, file);
  std::string body;
  outcome = exchange(file, request(address_, method, arguments), deadline, ending, body);
  if (outcome != Outcome::kAnswered) return outcome;
  result.clear();
  if (!parse(body, result)) return fail(Outcome::kNonsense, kNoMaster);
  problem_.clear();
  return Outcome::kAnswered;
}

int MasterClient::connect(double patience, const std::atomic<bool>& ending) {
  int file = -1;
  open(steadyNow() + patience, ending, file);
  return file;
}

}  // namespace laparoscope_servo
