#pragma once

namespace slammot::map_store {

struct MapStoreConfig {
  double busy_timeout_s = 0.5;     ///< How long to wait for another program that has the database
                                   ///< locked.
  int max_database_mb = 0;         ///< 0: as large as the disk.
  double retry_after_s = 1.0;      ///< After a submap could not be written.
  int max_unwritten_submaps = 64;  ///< Kept in memory while the database takes none; then the
                                   ///< oldest is dropped and counted.
};

}  // namespace slammot::map_store
