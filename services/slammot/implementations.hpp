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

/// An implementation of a stage. To add one, add a row to its table in implementations.cpp.
template <class Stage>
struct Implementation {
  std::string_view name;     ///< Name in the settings: implementations { tracking: "NAME" }.
  std::string_view program;  ///< Executable of its service: slammot-PROGRAM, beside slammot.
  bool can_continue_map;     ///< Implements go_on_after() and, as a service, --continue-map.
  /// `help`, if not null, must outlive the stage.
  std::unique_ptr<Stage> (*make)(const Profile& profile, work::SideWork* help);
};

using LocalizationImplementation = Implementation<stages::LocalizationStage>;
using TrackingImplementation = Implementation<stages::TrackingStage>;

/// All implementations; the first is the default.
std::span<const LocalizationImplementation> localization_implementations();
std::span<const TrackingImplementation> tracking_implementations();

/// The implementation that the settings name. Precondition: find_fault() is empty.
const LocalizationImplementation& localization_of(const ImplementationChoice& choice);
const TrackingImplementation& tracking_of(const ImplementationChoice& choice);

/// Message about the first unknown name.
std::optional<std::string> find_fault(const ImplementationChoice& choice);

/// Stages with an implementation other than the default: "tracking: greedy".
std::vector<std::string> replaced_stages(const ImplementationChoice& choice);

}  // namespace slammot
