#pragma once

namespace slammot::localization {

/// What may become of a scan.
enum class MapAdmission {
  kMapped,
  kDoubted,   ///< Waits until it is clear whether the vehicle is lost.
  kWithheld,  ///< Never goes into the map.
};

/// How sure it is where the vehicle is, when a scan that waited is due.
enum class PoseTrust { kConfirmed, kDoubted };

}  // namespace slammot::localization
