#include "common/app/give_way.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace slammot::app {

void give_way() {
  constexpr int kNice = 4;  // more, and a busy machine keeps old states only
  const sched_param priority{};
  ::sched_setscheduler(0, SCHED_BATCH, &priority);
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
}

}  // namespace slammot::app
