#include "services/collision_warning/collision_warning_service.hpp"

#include "common/wire/tracked_objects.hpp"
#include "services/collision_warning/collision_warning_fields.hpp"

namespace slammot::collision_warning {

std::vector<config::BoundStage> CollisionWarningService::stages(Settings& settings) {
  return {config::bind_stage("collision_warning", collision_warning_fields(), settings.config)};
}

CollisionWarningService::CollisionWarningService(app::ServiceContext& context,
                                                 const Settings& settings)
    : context_(context),
      monitor_(settings.config),
      warnings_(context.write(dds::topics::kCollisionWarnings)) {
  context.read(dds::topics::kTrackedObjects, app::Input::kSteady,
               [this](const auto& sample) { take(sample); });
}

void CollisionWarningService::take(const slammot_TrackedObjects& sample) {
  const auto tracked = wire::decode(sample);
  if (!tracked)
    return context_.warn("faulty_tracks", "dropped tracks: " + std::string(tracked.fault()));
  const app::Stopwatch stopwatch(context_.status().latency("assess"));
  const flow::CollisionWarnings warnings = monitor_.step(*tracked);
  warnings_.write(encoder_.encode(context_.vehicle_id(), warnings));
  context_.note_since_scan("scan_to_warnings", sample.scan_published_ns);
  count(warnings.highest_level);
}

/// Counts the beginnings of warnings.
void CollisionWarningService::count(flow::WarningLevel level) {
  const bool begins =
      level == flow::WarningLevel::kWarning && last_level_ != flow::WarningLevel::kWarning;
  context_.status().counter("warnings") += begins ? 1 : 0;
  last_level_ = level;
}

}  // namespace slammot::collision_warning
