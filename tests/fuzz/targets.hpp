#pragma once

#include <array>
#include <string_view>

namespace slammot::fuzz {

// Readers of bytes from outside. Each takes any bytes: it refuses them or returns what is usable,
// and aborts otherwise. The same functions are fuzzed by libFuzzer (tests/fuzz/run) and tested on
// the stored corpus and its mutations (ctest -L fuzz).

void read_mcap(std::string_view bytes);  ///< Recordings: summary, messages, verification, recovery.
void read_log(std::string_view bytes);   ///< Any format that `slammot run --input` takes.
void read_settings(std::string_view bytes);    ///< Profiles, settings, in textproto.
void read_traffic(std::string_view bytes);     ///< SUMO's XML.
void read_journal(std::string_view bytes);     ///< Of a collector that restarts.
void read_checkpoint(std::string_view bytes);  ///< Of localization: edits of an example.
void read_submap(std::string_view bytes);      ///< A blob of the map's database, or edits of one.
void read_submap_traffic(std::string_view bytes);  ///< Likewise, of what moved.
void read_map_database(std::string_view bytes);    ///< The SQLite file: edits of an example.
void read_client_message(std::string_view bytes);  ///< Of a viewer, on the WebSocket.
void read_sample(std::string_view bytes);          ///< First byte: topic of the table. Rest: CDR.

struct Target {
  std::string_view name;
  void (*read)(std::string_view bytes);
};

inline constexpr std::array kTargets = {Target{"mcap", read_mcap},
                                        Target{"log", read_log},
                                        Target{"settings", read_settings},
                                        Target{"traffic", read_traffic},
                                        Target{"journal", read_journal},
                                        Target{"checkpoint", read_checkpoint},
                                        Target{"submap", read_submap},
                                        Target{"submap_traffic", read_submap_traffic},
                                        Target{"map_database", read_map_database},
                                        Target{"client_message", read_client_message},
                                        Target{"sample", read_sample}};

}  // namespace slammot::fuzz
