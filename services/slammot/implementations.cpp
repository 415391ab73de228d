#include "services/slammot/implementations.hpp"

#include <algorithm>
#include <cassert>

#include "common/config/overlay.hpp"
#include "common/config/print.hpp"
#include "examples/greedy_tracker/greedy_tracker.hpp"
#include "examples/greedy_tracker/greedy_tracker_fields.hpp"
#include "examples/icp_localizer/icp_localizer.hpp"
#include "examples/icp_localizer/icp_localizer_fields.hpp"
#include "services/localization/localizer.hpp"
#include "services/tracking/tracker.hpp"

namespace slammot {
namespace {

/// Settings of an implementation that reads a subset of its stage's settings. Equal to those that
/// its own process reads from the same profile.
template <class Config>
Config settings_from(Profile profile, std::string_view stage,
                     const config::FieldTable<Config>& fields) {
  Config config;
  const std::vector<config::BoundStage> bound = {config::bind_stage(stage, fields, config)};
  [[maybe_unused]] const auto fault =
      config::overlay_text(config::print(bind_stages(profile)), "profile", bound);
  assert(!fault);
  return config;
}

constexpr LocalizationImplementation kLocalization[] = {
    {"standard", "localization", true,
     [](const Profile& profile,
        work::SideWork* help) -> std::unique_ptr<stages::LocalizationStage> {
       return std::make_unique<localization::Localizer>(profile.localization, help);
     }},
    {"icp", "icp-localizer", false,
     [](const Profile& profile, work::SideWork*) -> std::unique_ptr<stages::LocalizationStage> {
       return std::make_unique<icp_localizer::IcpLocalizer>(
           settings_from(profile, "localization", icp_localizer::icp_localizer_fields()));
     }},
};

constexpr TrackingImplementation kTracking[] = {
    {"standard", "tracking", true,
     [](const Profile& profile, work::SideWork* help) -> std::unique_ptr<stages::TrackingStage> {
       return std::make_unique<tracking::Tracker>(profile.tracking, help);
     }},
    {"greedy", "greedy-tracker", true,
     [](const Profile& profile, work::SideWork*) -> std::unique_ptr<stages::TrackingStage> {
       return std::make_unique<greedy_tracker::GreedyTracker>(
           settings_from(profile, "tracking", greedy_tracker::greedy_tracker_fields()));
     }},
};

template <class Stage>
const Implementation<Stage>* find(std::span<const Implementation<Stage>> all,
                                  std::string_view name) {
  const auto found = std::ranges::find(all, name, &Implementation<Stage>::name);
  return found == all.end() ? nullptr : &*found;
}

template <class Stage>
std::optional<std::string> find_fault_of(std::string_view stage,
                                         std::span<const Implementation<Stage>> all,
                                         std::string_view name) {
  if (find(all, name)) return std::nullopt;
  std::string names;
  for (const Implementation<Stage>& one : all)
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  return "implementations { " + std::string(stage) + ": \"" + std::string(name) +
         "\" }: no such implementation; there are: " + names;
}

}  // namespace

std::span<const LocalizationImplementation> localization_implementations() { return kLocalization; }
std::span<const TrackingImplementation> tracking_implementations() { return kTracking; }

const LocalizationImplementation& localization_of(const ImplementationChoice& choice) {
  const LocalizationImplementation* const found =
      find(localization_implementations(), choice.localization);
  assert(found != nullptr);
  return *found;
}

const TrackingImplementation& tracking_of(const ImplementationChoice& choice) {
  const TrackingImplementation* const found = find(tracking_implementations(), choice.tracking);
  assert(found != nullptr);
  return *found;
}

std::optional<std::string> find_fault(const ImplementationChoice& choice) {
  if (auto fault =
          find_fault_of("localization", localization_implementations(), choice.localization))
    return fault;
  return find_fault_of("tracking", tracking_implementations(), choice.tracking);
}

std::vector<std::string> replaced_stages(const ImplementationChoice& choice) {
  const ImplementationChoice defaults;
  std::vector<std::string> replaced;
  if (choice.localization != defaults.localization)
    replaced.push_back("localization: " + choice.localization);
  if (choice.tracking != defaults.tracking) replaced.push_back("tracking: " + choice.tracking);
  return replaced;
}

}  // namespace slammot
