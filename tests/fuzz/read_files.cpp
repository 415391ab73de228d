#include <cmath>
#include <variant>

#include "common/files/carmen_log.hpp"
#include "common/files/run_journal.hpp"
#include "common/mcap/message_cursor.hpp"
#include "services/recorder/bag_files.hpp"
#include "services/simulator/sumo_traffic.hpp"
#include "services/slammot/profile.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace slammot::fuzz {
namespace {

void read_messages(const mcap::File& file) {
  mcap::MessageCursor cursor(file, {});
  std::size_t messages = 0;
  while (const auto message = cursor.next()) {
    require(message->channel != nullptr, "a message has a channel");
    require(++messages < 10'000'000, "messages end");
  }
  for (const mcap::AttachmentIndex& index : file.contents().attachments)
    (void)file.attachment(index);
  for (const mcap::MetadataIndex& index : file.contents().metadata) (void)file.metadata(index);
}

void recover(const mcap::File& file) {
  const ScratchFile output("");
  const recorder::WrittenBag written = recorder::recover_bag(file, output.path());
  if (!written.fault.empty()) return require_one_line(written.fault);
  auto again = mcap::File::open_and_verify(output.path());
  require(again.has_value(), "what is recovered opens");
}

void require_usable(const files::LogEvent& event) {
  if (const auto* odometry = std::get_if<sensing::Odometry>(&event)) {
    require(std::isfinite(odometry->wheel_from_base.x_m + odometry->wheel_from_base.y_m +
                          odometry->wheel_from_base.heading_rad),
            "odometry is finite");
  } else if (const auto* scan = std::get_if<sensing::LaserScan>(&event)) {
    require(scan->range_m.size() <= files::kMaxBeams, "beams are bounded");
    require(std::isfinite(scan->scanner.max_range_m + scan->scanner.first_beam_rad +
                          scan->scanner.beam_step_rad),
            "a scanner is finite");
  }
}

}  // namespace

void read_mcap(std::string_view bytes) {
  const ScratchFile input(bytes);
  if (auto file = mcap::File::open(input.path())) read_messages(*file);
  auto verified = mcap::File::open_and_verify(input.path());
  if (!verified) return require_one_line(verified.error().message);
  read_messages(*verified);
  recover(*verified);
}

void read_log(std::string_view bytes) {
  const ScratchFile input(bytes);
  files::CarmenLogOptions options;
  options.uses_all_scanners = true;
  auto log = files::CarmenLog::open(input.path(), options);
  if (!log) return require_one_line(log.error().message);
  while (const auto event = log->next()) require_usable(*event);
}

void read_settings(std::string_view bytes) {
  Profile profile;
  const auto stages = bind_stages(profile);
  if (const auto fault = config::overlay_text(std::string(bytes), "file", stages))
    return require_one_line(fault->text());
  for (const auto& stage : stages) require(!config::find_fault(stage), "settings are in range");
}

void read_traffic(std::string_view bytes) {
  const ScratchFile input(bytes);
  auto objects = simulator::read_sumo_traffic(input.path());
  if (!objects) require_one_line(objects.error().message);
}

void read_journal(std::string_view bytes) {
  const ScratchFile input(bytes);
  const auto content = files::RunJournal::read(input.path());
  if (!content) return;
  for (const auto& scan : content->localized_scans)
    require(std::isfinite(scan.odom_from_base.pose.x_m), "a pose is finite");
}

}  // namespace slammot::fuzz
