// A thread with all signals blocked, so that they go to the main thread and interrupt its system calls.
#pragma once

#include <signal.h>

#include <thread>
#include <utility>

namespace laparoscope_servo {

template <typename Function>
std::thread startQuietThread(Function&& function) {
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::forward<Function>(function));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace laparoscope_servo
