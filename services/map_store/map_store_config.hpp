#pragma once

namespace slammot::map_store {

struct MapStoreConfig {
  double busy_timeout_s = 0.5;     ///< Longest wait for a database that another program has locked.
  int max_database_mb = 0;         ///< 0: limited by the disk only.
  double retry_after_s = 1.0;      ///< Interval of attempts after a failed write.
  int max_unwritten_submaps = 64;  ///< In memory after failed writes; the oldest beyond that number
                                   ///< is dropped and counted.
};

}  // namespace slammot::map_store
