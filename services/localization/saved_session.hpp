#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/flow/localized_scan.hpp"

namespace slammot::localization {

/// What the service needs to go on after a crash, besides what the localizer does.
struct SavedSession {
  flow::MapId map_id;
  flow::OdomId odom_id;
  flow::SubmapId first_submap_id;  ///< Of this drive.
  std::map<std::string, std::uint64_t> drive_by_scanner;
  std::vector<flow::LocalizedScan> last_answers;  ///< The newest scan of each scanner, without its
                                                  ///< beams.
  bool has_ended = false;  ///< The process ended in order: no scan was localized afterwards.
  std::vector<std::byte> localizer;  ///< Localizer::checkpoint().
};

std::vector<std::byte> to_bytes(const SavedSession& session);

/// None for bytes that are no session's. The localizer's are taken as they are: it checks them
/// itself.
std::optional<SavedSession> session_of(std::span<const std::byte> bytes);

}  // namespace slammot::localization
