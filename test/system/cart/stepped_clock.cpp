// In front of libc (LD_PRELOAD): the clock that is set, see stepped_clock.h. Adds the number in the file STEPPED_CLOCK.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

namespace {

double offset() {
  static const volatile double* const shared = [] {
    const char* file = std::getenv("STEPPED_CLOCK");
    const int handle = file == nullptr ? -1 : ::open(file, O_RDONLY | O_CLOEXEC);
    if (handle < 0) return static_cast<const volatile double*>(nullptr);
    void* memory = ::mmap(nullptr, sizeof(double), PROT_READ, MAP_SHARED, handle, 0);
    ::close(handle);
    return memory == MAP_FAILED ? nullptr : static_cast<const volatile double*>(memory);
  }();
  return shared == nullptr ? 0.0 : *shared;
}

void add(timespec& time, double seconds) {
  const double whole = std::floor(seconds);
  time.tv_sec += static_cast<time_t>(whole);
  time.tv_nsec += static_cast<long>((seconds - whole) * 1e9);
  if (time.tv_nsec < 1000000000L) return;
  time.tv_nsec -= 1000000000L;
  ++time.tv_sec;
}

template <typename Function>
Function* next(const char* name, const char* version = nullptr) {
  void* const found = version == nullptr ? ::dlsym(RTLD_NEXT, name) : ::dlvsym(RTLD_NEXT, name, version);
  return reinterpret_cast<Function*>(found);
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static auto* const real = next<int(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) add(*time, offset());
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return result;
}

time_t time(time_t* result) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (result != nullptr) *result = now.tv_sec;
  return now.tv_sec;
}

// The kernel waits by the clock that nobody has set. A time since 1970 is not one since the machine was started.
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  using Wait = int(pthread_cond_t*, pthread_mutex_t*, const timespec*);
  static Wait* const real = [] {
    Wait* const newest = next<Wait>("pthread_cond_timedwait", "GLIBC_2.3.2");  // the name has an older meaning, too
    return newest != nullptr ? newest : next<Wait>("pthread_cond_timedwait");
  }();
  constexpr time_t kSince1970 = 1000000000;  // s
  timespec then = *until;
  if (then.tv_sec > kSince1970) add(then, -offset());
  return real(condition, mutex, &then);
}
}
