#include "common/files/run_journal.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

namespace slammot::files {
namespace {

constexpr const char* kBegin = "slammot-journal-4";
constexpr char kEndOfLine = ';';  // marks a completely written line

std::ostream& operator<<(std::ostream& to, const geometry::Pose2& pose) {
  return to << pose.x_m << ' ' << pose.y_m << ' ' << pose.heading_rad;
}
std::istream& operator>>(std::istream& from, geometry::Pose2& pose) {
  return from >> pose.x_m >> pose.y_m >> pose.heading_rad;
}
std::ostream& operator<<(std::ostream& to, const DriveName& drive) {
  return to << drive.map_id.value << ' ' << drive.odom_id.value;
}
std::istream& operator>>(std::istream& from, DriveName& drive) {
  return from >> drive.map_id.value >> drive.odom_id.value;
}
std::istream& operator>>(std::istream& from, geometry::Vector2& vector) {
  return from >> vector.x() >> vector.y();
}

template <typename Enum>
std::istream& get_enumerator(std::istream& from, Enum& value) {
  int number = 0;
  from >> number;
  value = static_cast<Enum>(number);
  return from;
}

/// A line from which values are restored exactly.
class Line {
 public:
  Line() { text_.precision(std::numeric_limits<double>::max_digits10); }
  template <typename Value>
  Line& operator<<(const Value& value) {
    text_ << value << ' ';
    return *this;
  }
  std::string str() const { return text_.str() + kEndOfLine + '\n'; }

 private:
  std::ostringstream text_;
};

flow::LocalizedScan localized_scan_of(std::istream& line) {
  flow::LocalizedScan scan;
  line >> scan.stamp_ns >> scan.map_id.value >> scan.submap_id.value >> scan.map_from_odom >>
      scan.odom_from_base.pose >> scan.submap_from_base;
  return scan;
}

flow::TrackedObject object_of(std::istream& line) {
  flow::TrackedObject object;
  object.confirmed = true;
  line >> object.track_id.value >> object.position_in_odom_m >> object.velocity_in_odom_mps >>
      object.heading_in_odom_rad >> object.length_m >> object.width_m >> object.existence;
  get_enumerator(line, object.motion);
  get_enumerator(line, object.object_class);
  line >> object.occluded;
  return object;
}

flow::TrackedObjects tracked_objects_of(std::istream& line) {
  flow::TrackedObjects tracked;
  std::size_t count = 0;
  line >> tracked.stamp_ns >> tracked.map_id.value >> tracked.map_from_odom >> count;
  for (std::size_t i = 0; i < count && line; ++i) tracked.objects.push_back(object_of(line));
  return tracked;
}

DriveName drive_of(std::istream& line) {
  DriveName drive;
  line >> drive;
  return drive;
}

JournalScan scan_of(std::istream& line) {
  JournalScan scan;
  line >> scan.drive_id >> scan.sequence >> scan.stamp_ns >> scan.scanner_id;
  return scan;
}

}  // namespace

void RunJournal::begin(const DriveName& drive, std::span<const DriveName> ended) {
  stream_ = std::ofstream(file_, std::ios::trunc);
  stream_ << kBegin << ' ' << drive << '\n';
  for (const DriveName& one : ended) stream_ << (Line() << 'e' << one).str();
  stream_ << std::flush;
}

void RunJournal::resume() {
  stream_ = std::ofstream(file_, std::ios::app);
  stream_ << '\n' << std::flush;  // ends an incomplete line
}

void RunJournal::remove() {
  stream_.close();
  std::error_code not_there;
  std::filesystem::remove(file_, not_there);
}

void RunJournal::add(const JournalScan& scan) {
  stream_
      << (Line() << 's' << scan.drive_id << scan.sequence << scan.stamp_ns << scan.scanner_id).str()
      << std::flush;
}

void RunJournal::add(const flow::LocalizedScan& scan) {
  stream_ << (Line() << 'l' << scan.stamp_ns << scan.map_id.value << scan.submap_id.value
                     << scan.map_from_odom << scan.odom_from_base.pose << scan.submap_from_base)
                 .str()
          << std::flush;
}

void RunJournal::add(const flow::TrackedObjects& tracked) {
  const auto confirmed = std::ranges::count(tracked.objects, true, &flow::TrackedObject::confirmed);
  Line line;
  line << 't' << tracked.stamp_ns << tracked.map_id.value << tracked.map_from_odom << confirmed;
  for (const flow::TrackedObject& object : tracked.objects) {
    if (!object.confirmed) continue;
    line << object.track_id.value << object.position_in_odom_m.x() << object.position_in_odom_m.y()
         << object.velocity_in_odom_mps.x() << object.velocity_in_odom_mps.y()
         << object.heading_in_odom_rad << object.length_m << object.width_m << object.existence
         << static_cast<int>(object.motion) << static_cast<int>(object.object_class)
         << object.occluded;
  }
  stream_ << line.str() << std::flush;
}

std::optional<RunJournal::Content> RunJournal::read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string mark;
  Content content;
  if (!(stream >> mark >> content.drive) || mark != kBegin) return std::nullopt;
  for (std::string text; std::getline(stream, text);) {
    if (!text.ends_with(kEndOfLine)) continue;
    std::istringstream line(text);
    char kind = 0;
    line >> kind;
    const auto keep = [&](auto& values, auto value) {
      if (line) values.push_back(std::move(value));
    };
    if (kind == 'e') keep(content.ended, drive_of(line));
    if (kind == 's') keep(content.scans, scan_of(line));
    if (kind == 'l') keep(content.localized_scans, localized_scan_of(line));
    if (kind == 't') keep(content.tracked_objects, tracked_objects_of(line));
  }
  return content;
}

}  // namespace slammot::files
