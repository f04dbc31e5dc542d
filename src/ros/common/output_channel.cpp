#include "ros/common/output_channel.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "ros/common/quiet_thread.h"

namespace laparoscope_servo {

namespace {

constexpr std::size_t kQueue = 1u << 20;     // bytes: some ten thousand lines
constexpr std::size_t kLongLine = 1u << 16;  // bytes: longer lines are passed on in parts
constexpr int kUnfinishedLine = 20;          // ms, after which an incomplete line is passed on

std::uint64_t lines(const std::string& text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string notice(std::uint64_t count) {
  return "[" + std::to_string(count) + " lines of this log were dropped: they were not read in time]\n";
}

}  // namespace

OutputChannel::OutputChannel(int pipe, int target) : pipe_(pipe), target_(target) {
  startQuietThread([this] { collect(); }).detach();
  startQuietThread([this] { deliver(); }).detach();
}

bool OutputChannel::isEmpty() const {
  int waiting = 0;
  if (::ioctl(pipe_, FIONREAD, &waiting) != 0) return true;
  return waiting == 0 && !collecting_ && pending_ == 0;
}

void OutputChannel::collect() {
  std::string text;
  std::array<char, 65536> buffer;
  while (true) {
    pollfd entry{pipe_, POLLIN, 0};
    if (::poll(&entry, 1, text.empty() ? -1 : kUnfinishedLine) == 0) {
      push(std::exchange(text, {}));
      continue;
    }
    collecting_ = true;
    const ssize_t count = ::read(pipe_, buffer.data(), buffer.size());
    if (count > 0) pending_ += count;
    collecting_ = false;
    if (count == 0) return push(std::move(text));  // the other end is closed
    if (count < 0) continue;
    text.append(buffer.data(), static_cast<std::size_t>(count));
    const std::size_t end = text.size() > kLongLine ? text.size() : text.rfind('\n') + 1;
    if (end == 0) continue;
    std::string rest = text.substr(end);
    text.resize(end);
    push(std::exchange(text, std::move(rest)));
  }
}

void OutputChannel::push(std::string text) {
  if (text.empty()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (queued_ + text.size() > kQueue) {
    unsaid_ += lines(text);
    dropped_ += lines(text);
    pending_ -= static_cast<std::int64_t>(text.size());
    return;
  }
  if (unsaid_ > 0) {
    const std::string said = notice(std::exchange(unsaid_, 0));
    pending_ += static_cast<std::int64_t>(said.size());
    text = said + text;
  }
  queued_ += text.size();
  queue_.push_back(std::move(text));
  arrived_.notify_one();
}

void OutputChannel::deliver() {
  while (true) {
    std::string text;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      arrived_.wait(lock, [this] { return !queue_.empty(); });
      text = std::move(queue_.front());
      queue_.pop_front();
      // Also if no further line follows the dropped ones.
      if (queue_.empty() && unsaid_ > 0) {
        queue_.push_back(notice(std::exchange(unsaid_, 0)));
        queued_ += queue_.back().size();
        pending_ += static_cast<std::int64_t>(queue_.back().size());
      }
    }
    write(text);
    const std::lock_guard<std::mutex> lock(mutex_);
    queued_ -= text.size();
    pending_ -= static_cast<std::int64_t>(text.size());
  }
}

// Drops text that cannot be written, as on a full disk or to a closed terminal.
void OutputChannel::write(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(target_, text.data() + done, text.size() - done);
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {  // another process has made the terminal non-blocking
      pollfd entry{target_, POLLOUT, 0};
      ::poll(&entry, 1, -1);
    } else if (errno != EINTR) {
      dropped_ += lines(text.substr(done));
      return;
    }
  }
}

}  // namespace laparoscope_servo
