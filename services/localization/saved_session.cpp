#include "services/localization/saved_session.hpp"

#include "services/localization/byte_stream.hpp"

namespace slammot::localization {
namespace {

constexpr std::uint64_t kSessionMark = 0x7365'7373'696f'6e34;  // "session4": the digit counts the
                                                               // forms of a session
constexpr std::uint64_t kMostScanners = 64;

void put_text(std::vector<std::byte>& bytes, const std::string& text) {
  put_all(bytes, std::vector<char>(text.begin(), text.end()));
}

std::string get_text(ByteReader& from) {
  std::vector<char> text;
  from.get_all(text);
  return {text.begin(), text.end()};
}

/// Calls visit with every plain member; the scanner's name and the beams are not among them.
template <typename Scan, typename Visit>
void visit_members(Scan& scan, Visit visit) {
  visit(scan.stamp_ns);
  visit(scan.sequence);
  visit(scan.base_from_laser);
  visit(scan.max_range_m);
  visit(scan.beam_step_rad);
  visit(scan.sweep_s);
  visit(scan.odom_from_base.pose);
  visit(scan.odom_from_base.covariance);
  visit(scan.map_from_odom);
  visit(scan.speed_mps);
  visit(scan.yaw_rate_radps);
  visit(scan.map_id.value);
  visit(scan.odom_id.value);
  visit(scan.submap_id.value);
  visit(scan.submap_from_base);
}

flow::LocalizedScan get_answer(ByteReader& from) {
  flow::LocalizedScan answer;
  answer.scanner_id = get_text(from);
  visit_members(answer, [&](auto& member) { from.get(member); });
  return answer;
}

bool is_believable(const flow::LocalizedScan& answer) {
  using localization::is_believable;
  return is_believable(answer.base_from_laser) && is_believable(answer.odom_from_base.pose) &&
         is_believable(answer.map_from_odom) && is_believable(answer.submap_from_base);
}

}  // namespace

std::vector<std::byte> to_bytes(const SavedSession& session) {
  std::vector<std::byte> bytes;
  put(bytes, kSessionMark);
  put(bytes, session.map_id.value);
  put(bytes, session.odom_id.value);
  put(bytes, session.first_submap_id.value);
  put(bytes, std::uint64_t{session.drive_by_scanner.size()});
  for (const auto& [scanner_id, drive_id] : session.drive_by_scanner) {
    put_text(bytes, scanner_id);
    put(bytes, drive_id);
  }
  put(bytes, std::uint64_t{session.last_answers.size()});
  for (const flow::LocalizedScan& answer : session.last_answers) {
    put_text(bytes, answer.scanner_id);
    visit_members(answer, [&](const auto& member) { put(bytes, member); });
  }
  put(bytes, session.has_ended);
  put_all(bytes, session.localizer);
  return bytes;
}

std::optional<SavedSession> session_of(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  SavedSession session;
  std::uint64_t mark = 0, drives = 0, answers = 0;
  from.get(mark);
  from.get(session.map_id.value);
  from.get(session.odom_id.value);
  from.get(session.first_submap_id.value);
  from.get(drives);
  if (mark != kSessionMark || drives > kMostScanners) return std::nullopt;
  for (std::uint64_t i = 0; i < drives; ++i) {
    const std::string scanner_id = get_text(from);
    from.get(session.drive_by_scanner[scanner_id]);
  }
  from.get(answers);
  if (answers > kMostScanners) return std::nullopt;
  for (std::uint64_t i = 0; i < answers; ++i) {
    session.last_answers.push_back(get_answer(from));
    if (!is_believable(session.last_answers.back())) return std::nullopt;
  }
  from.get(session.has_ended);
  from.get_all(session.localizer);
  if (!from.ok() || !from.at_end()) return std::nullopt;
  return session;
}

}  // namespace slammot::localization
