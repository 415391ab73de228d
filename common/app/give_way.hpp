#pragma once

namespace slammot::app {

/// The calling thread, and those that it starts, interrupt no other thread when they wake up, and
/// get less than half of a busy core: SCHED_BATCH and a nice value of 4 (sched(7)). For what is not
/// on the way of a scan. Where the system refuses, nothing changes.
void give_way();

}  // namespace slammot::app
