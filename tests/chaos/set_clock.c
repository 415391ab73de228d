/* Preloaded, it steps the system clock of a process alone, as the kernel does: what waits until a time of that clock waits for the
   new one. The offset [ns] stands in the file SLAMMOT_TEST_CLOCK, as 8 bytes, and may change at any time. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const volatile int64_t* offset_ns;

__attribute__((constructor)) static void open_clock(void) {
  const char* path = getenv("SLAMMOT_TEST_CLOCK");
  const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) return;
  void* memory = mmap(NULL, sizeof(int64_t), PROT_READ, MAP_SHARED, file, 0);
  if (memory != MAP_FAILED) offset_ns = memory;
  close(file);
}

static int64_t nanoseconds(clockid_t clock) {
  struct timespec time;
  syscall(SYS_clock_gettime, clock, &time);
  return time.tv_sec * INT64_C(1000000000) + time.tv_nsec;
}

static int64_t system_clock(void) { return nanoseconds(CLOCK_REALTIME) + (offset_ns ? *offset_ns : 0); }

static struct timespec timespec_of(int64_t ns) {
  struct timespec time = {ns / 1000000000, ns % 1000000000};
  return time;
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  if (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE) return (int)syscall(SYS_clock_gettime, clock, time);
  *time = timespec_of(system_clock());
  return 0;
}

int gettimeofday(struct timeval* restrict time, void* restrict zone) {
  (void)zone;
  const int64_t ns = system_clock();
  time->tv_sec = ns / 1000000000;
  time->tv_usec = ns % 1000000000 / 1000;
  return 0;
}

time_t time(time_t* result) {
  const time_t now = system_clock() / 1000000000;
  if (result) *result = now;
  return now;
}

/* In turns of 20 ms, each of which looks at the clock again. Times before 2001 are those of another clock. */
int pthread_cond_timedwait(pthread_cond_t* restrict condition, pthread_mutex_t* restrict mutex, const struct timespec* restrict until) {
  static int (*wait)(pthread_cond_t*, pthread_mutex_t*, const struct timespec*);
  if (!wait) *(void**)&wait = dlsym(RTLD_NEXT, "pthread_cond_timedwait");
  if (until->tv_sec < 1000000000) return wait(condition, mutex, until);
  const int64_t end = until->tv_sec * INT64_C(1000000000) + until->tv_nsec;
  for (int64_t left; (left = end - system_clock()) > 0;) {
    const struct timespec turn = timespec_of(nanoseconds(CLOCK_MONOTONIC) + (left < 20000000 ? left : 20000000));
    const int result = pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &turn);
    if (result != ETIMEDOUT) return result;
  }
  return ETIMEDOUT;
}
