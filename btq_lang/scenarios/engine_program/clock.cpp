// Takes the place of the C++ library's steady clock, and of waiting for a time on it.
//
// Timers of the engine (Timeout, Delay, Sleep) have each a thread that waits on a condition variable until a time of the
// steady clock.  The dynamic linker finds both functions in the program before it looks into libraries.
#include "clock.hpp"

#include <cerrno>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <thread>
#include <vector>

namespace
{
constexpr int64_t MILLISECOND = 1'000'000;  // in nanoseconds, as all times here
constexpr int64_t BEGIN = 1'000'000'000;  // the engine takes a timer that is due at 0 for one that is cancelled
constexpr int64_t POLL = 10 * MILLISECOND;  // how long a thread without a timer waits before it looks again
constexpr int PATIENCE = 5000;  // real milliseconds

struct Sleeper
{
  pid_t thread;
  int64_t deadline;
  bool is_idle;  // it has no timer, and time alone does not give it one
  bool is_poked;
  bool is_released;
  std::condition_variable wakes;
};

const std::thread::id MAIN = std::this_thread::get_id();
std::atomic<int64_t> time_now = BEGIN;
std::mutex mutex;  // of all below
std::condition_variable changed;
std::vector<Sleeper*> sleepers;
size_t threads = 0;  // beside the main one
thread_local bool may_have_timer = true;

size_t otherThreads()
{
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}) - 1;
}

void waitForAll(std::unique_lock<std::mutex>& lock)
{
  changed.wait(lock, [] { return sleepers.size() == threads; });
}

void release(Sleeper& sleeper, bool is_poked)
{
  sleepers.erase(std::find(sleepers.begin(), sleepers.end(), &sleeper));
  sleeper.is_poked = is_poked;
  sleeper.is_released = true;
  sleeper.wakes.notify_one();
}

void sleepUntil(int64_t deadline)
{
  std::unique_lock<std::mutex> lock(mutex);
  Sleeper sleeper{ gettid(), deadline, !may_have_timer && deadline == time_now + POLL, false, false, {} };
  sleepers.push_back(&sleeper);
  changed.notify_one();
  sleeper.wakes.wait(lock, [&] { return sleeper.is_released; });
  may_have_timer = sleeper.is_poked;
}
}  // namespace

bool virtual_clock::has_slept = false;

int64_t virtual_clock::now()
{
  return (time_now - BEGIN) / MILLISECOND;
}

bool virtual_clock::begin()
{
  for(int i = 0; i < PATIENCE; i++)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      threads = otherThreads();
      if(sleepers.size() == threads)
        return true;
    }
    usleep(1000);
  }
  return false;
}

void virtual_clock::poke()
{
  std::unique_lock<std::mutex> lock(mutex);
  const std::vector<Sleeper*> all = sleepers;
  for(Sleeper* sleeper : all)
    release(*sleeper, true);
  waitForAll(lock);
}

void virtual_clock::advance(int64_t until)
{
  std::unique_lock<std::mutex> lock(mutex);
  int64_t next = BEGIN + until * MILLISECOND;
  for(const Sleeper* sleeper : sleepers)
  {
    if(!sleeper->is_idle)
      next = std::min(next, sleeper->deadline);
  }
  time_now = std::max<int64_t>(time_now, next);
  std::vector<Sleeper*> due;
  std::copy_if(sleepers.begin(), sleepers.end(), std::back_inserter(due), [](const Sleeper* sleeper) {
    return !sleeper->is_idle && sleeper->deadline <= time_now;
  });
  std::sort(due.begin(), due.end(), [](const Sleeper* a, const Sleeper* b) { return a->thread < b->thread; });
  for(Sleeper* sleeper : due)
  {
    release(*sleeper, false);
    waitForAll(lock);
  }
}

std::chrono::steady_clock::time_point std::chrono::steady_clock::now() noexcept
{
  return time_point(nanoseconds(time_now));
}

extern "C" int pthread_cond_clockwait(pthread_cond_t*, pthread_mutex_t* held, clockid_t, const timespec* until)
{
  const int64_t deadline = until->tv_sec * 1'000 * MILLISECOND + until->tv_nsec;
  if(std::this_thread::get_id() == MAIN)
  {
    virtual_clock::has_slept = true;
    return ETIMEDOUT;
  }
  if(deadline <= time_now)
    return ETIMEDOUT;
  pthread_mutex_unlock(held);
  sleepUntil(deadline);
  pthread_mutex_lock(held);
  return deadline <= time_now ? ETIMEDOUT : 0;
}
