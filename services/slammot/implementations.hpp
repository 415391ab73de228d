#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/stages/localization_stage.hpp"
#include "common/stages/tracking_stage.hpp"
#include "common/work/side_work.hpp"
#include "services/slammot/profile.hpp"

namespace slammot {

/// One implementation of a stage. A new one is a new row of its table in implementations.cpp.
template <class Stage>
struct Implementation {
  std::string_view name;      ///< In the settings: implementations { tracking: "NAME" }.
  std::string_view program;   ///< That runs it as a service: slammot-PROGRAM, beside slammot.
  bool takes_up_stored_maps;  ///< Implements go_on_after() and, as a program, --continue-map.
  /// help, where not null, outlives the stage.
  std::unique_ptr<Stage> (*make)(const Profile& profile, work::SideWork* help);
};

using LocalizationImplementation = Implementation<stages::LocalizationStage>;
using TrackingImplementation = Implementation<stages::TrackingStage>;

/// All implementations; the first one is the default.
std::span<const LocalizationImplementation> localization_implementations();
std::span<const TrackingImplementation> tracking_implementations();

/// The row that the settings name. Precondition: find_fault() is empty.
const LocalizationImplementation& localization_of(const ImplementationChoice& choice);
const TrackingImplementation& tracking_of(const ImplementationChoice& choice);

/// One line on the first name that no table has.
std::optional<std::string> find_fault(const ImplementationChoice& choice);

/// Names of the stages whose implementation is not the default, with the implementation: "tracking:
/// greedy".
std::vector<std::string> replaced_stages(const ImplementationChoice& choice);

}  // namespace slammot
