#include "laparoscope_servo/aesop/wire_log_file.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

namespace {

// bytes, of several minutes: with a larger backlog the disk counts as faulty
constexpr std::size_t kLargestBacklog = 1 << 20;
constexpr std::chrono::milliseconds kPause{200};  // between two writes
constexpr double kMegabyte = 1e6;

std::int64_t wallTime() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

void describe(parameters::Table& table, WireLogConfig& c) {
  table.text("file", c.file, "absolute path; empty: nothing is recorded");
  table.number("size", c.size, {0.1, 1000}, "MB", "a full file becomes file.1 and so on; an hour takes about 20");
  table.number("files", c.files, {1, 100}, "files", "that are kept");
}

std::vector<std::string> validate(const WireLogConfig& config) {
  return parameters::errorsOf(config);
}

class WireLogFile::Writer {
 public:
  Writer(const WireLogConfig& config, const std::string& codec) : config_(config), codec_(codec) {
    // Signals are for the thread that drives the arm; a limit on the file size must not kill the process.
    sigset_t all;
    sigset_t before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  ~Writer() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
    if (file_ >= 0) ::close(file_);
  }

  void take(const WireRecord& record) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!problem_.empty()) return;
    if (record.event == WireEvent::kState) last_state_ = record;
    if (segments_ == 0 || segment_size_ >= config_.size * kMegabyte) begin(record.time);
    Bytes& bytes = waiting_.back();
    const std::size_t before = bytes.size();
    encoder_.add(record, bytes);
    const std::size_t added = bytes.size() - before;
    segment_size_ += static_cast<double>(added);
    backlog_ += added;
    if (backlog_ > kLargestBacklog) stop("the disk does not keep up with writing");
  }

  std::string problem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return problem_;
  }

 private:
  // Begins a new file, with the present state first, since the earlier records are in another file.
  void begin(std::int64_t time) {
    if (waiting_.empty() || segments_ > 0) waiting_.emplace_back();
    encoder_.begin({wallTime(), time, codec_}, waiting_.back());
    if (segments_ > 0) encoder_.add({WireEvent::kState, time, last_state_.payload}, waiting_.back());
    segment_size_ = 0.0;
    ++segments_;
  }

  // With mutex_ held.
  void stop(const std::string& problem) {
    problem_ = "the recording '" + config_.file + "' has ended: " + problem;
    waiting_.clear();
  }

  void run() {
    // The thread that drives the arm may have a real-time priority, which this one would inherit.
    const sched_param ordinary{};
    ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
    std::unique_lock<std::mutex> lock(mutex_);
    for (bool last = false; !last && problem_.empty();) {
      wake_.wait_for(lock, kPause, [this] { return ending_; });
      last = ending_;
      std::vector<Bytes> pieces;
      pieces.swap(waiting_);
      // Appends to the same file, after the records that are being written now.
      if (segments_ > 0) waiting_.emplace_back();
      backlog_ = 0;
      lock.unlock();
      const std::string problem = write(pieces);
      lock.lock();
      if (!problem.empty()) stop(problem);
    }
  }

  // Each piece but the first begins a new file. Returns what went wrong.
  std::string write(const std::vector<Bytes>& pieces) {
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (k > 0 || file_ < 0) {
        const std::string problem = open();
        if (!problem.empty()) return problem;
      }
      const std::string problem = write(pieces[k]);
      if (!problem.empty()) return problem;
    }
    return "";
  }

  std::string write(const Bytes& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::write(file_, bytes.data() + at, bytes.size() - at);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::strerror(errno);
      at += static_cast<std::size_t>(count);
    }
    return "";
  }

  std::string open() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
    struct stat existing {};
    if (::lstat(config_.file.c_str(), &existing) == 0) {
      if (!S_ISREG(existing.st_mode)) return "there is something else of this name, expected a regular file or nothing";
      const std::string problem = rotate();
      if (!problem.empty()) return problem;
    }
    file_ = ::open(config_.file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    return file_ < 0 ? std::strerror(errno) : "";
  }

  std::string rotate() const {
    const auto name = [this](int k) { return config_.file + (k > 0 ? "." + std::to_string(k) : ""); };
    if (config_.files == 1) return ::unlink(config_.file.c_str()) == 0 ? "" : std::strerror(errno);
    for (int k = config_.files - 1; k > 0; --k) {
      if (std::rename(name(k - 1).c_str(), name(k).c_str()) != 0 && errno != ENOENT) {
        return "'" + name(k) + "': " + std::strerror(errno);
      }
    }
    return "";
  }

  const WireLogConfig config_;
  const std::string codec_;
  int file_ = -1;  // used by the thread only

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  WireLogEncoder encoder_;
  std::vector<Bytes> waiting_;
  std::size_t backlog_ = 0;
  double segment_size_ = 0.0;
  std::uint64_t segments_ = 0;
  WireRecord last_state_;
  std::string problem_;

  std::thread thread_;
};

WireLogFile::WireLogFile(const WireLogConfig& config, const std::string& codec)
    : writer_(std::make_unique<Writer>(config, codec)) {}

WireLogFile::~WireLogFile() = default;

void WireLogFile::take(const WireRecord& record) {
  writer_->take(record);
}

std::string WireLogFile::problem() const {
  return writer_->problem();
}

}  // namespace laparoscope_servo::aesop
