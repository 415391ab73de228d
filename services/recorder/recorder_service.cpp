#include "services/recorder/recorder_service.hpp"

#include <csignal>
#include <ctime>
#include <fstream>
#include <iterator>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/app/system_clock.hpp"
#include "common/app/version.hpp"
#include "common/config/profiles.hpp"
#include "common/files/number_option.hpp"

namespace slammot::recorder {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookPeriod = 50ms;
/// Far less than what the readers hold.
constexpr auto kTakePeriod = 20ms;
/// Time within which others describe a type: 1 ms where they are well.
constexpr auto kTypePatience = 20ms;
constexpr int kMostAttempts = 100;
constexpr std::int16_t kCdrVersion2 = 2;  ///< Of all types that are compiled in: appendable.
/// What was added is in the file after this time at the latest.
constexpr auto kFlushPeriod = 1s;

/// "car-20250131T235959Z.mcap"
std::string default_name(const std::string& vehicle_id) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "-%Y%m%dT%H%M%SZ.mcap", &utc);
  return vehicle_id + text;
}

std::filesystem::path path_of(const RecorderService::Settings& settings,
                              const app::ServiceOptions& options) {
  if (!settings.output.empty()) return settings.output;
  std::error_code fault;
  std::filesystem::create_directories(options.state_dir, fault);
  return options.state_dir / default_name(options.vehicle_id);
}

void attach(const std::filesystem::path& path, std::vector<mcap::Attachment>& attachments) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  mcap::Attachment attachment{app::system_clock_ns(), 0, path.filename(), "text/plain", {}};
  attachment.data.assign(std::istreambuf_iterator<char>(file), {});
  attachments.push_back(std::move(attachment));
}

/// The files of settings that the recorder was given, and what the recording was made with.
RecordingOptions options_of(const RecorderService::Settings& settings,
                            const app::ServiceOptions& service) {
  RecordingOptions options = settings.recording;
  options.path = path_of(settings, service);
  options.compression =
      mcap::compression_of(settings.compression).value_or(mcap::Compression::kZstd);
  options.metadata.push_back({"software",
                              {{"name", "slammot"},
                               {"version", std::string(app::kVersion)},
                               {"vehicle", service.vehicle_id},
                               {"dds_domain", std::to_string(service.domain_id)}}});
  if (!service.profile.empty()) {
    if (const auto profile = config::find_profile(service.profile))
      attach(*profile, options.attachments);
  }
  for (const std::string& file : service.config_files) attach(file, options.attachments);
  return options;
}

}  // namespace

void RecorderService::add_options(CLI::App& command_line, Settings& settings) {
  command_line
      .add_option("--output", settings.output,
                  "File to write; by default VEHICLE-TIME.mcap in the state folder")
      ->type_name("FILE");
  command_line
      .add_option(
          "--topics", settings.topics,
          "Topics to record, comma-separated; all by default. A trailing '*' stands for all "
          "that begin like it")
      ->type_name("NAME,...")
      ->delimiter(',');
  command_line.add_option("--compression", settings.compression, "Of chunks: none, lz4 or zstd")
      ->check(CLI::IsMember({"none", "lz4", "zstd"}))
      ->capture_default_str();
  command_line
      .add_option("--duration", settings.duration_s, "Ends after so many seconds; 0: when stopped")
      ->check(files::seconds_option())
      ->capture_default_str();
}

RecorderService::RecorderService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      topics_(settings.topics),
      ends_on_fault_(settings.ends_on_fault),
      discovery_(context.participant()),
      last_look_ns_(app::system_clock_ns()) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of the file's size is a full disk, no reason to die
  const RecordingOptions options = options_of(settings, context.options());
  path_ = options.path;
  if (std::filesystem::exists(path_))
    throw app::StartupFailure(path_.string() + " exists: recordings are never overwritten");
  recording_ = std::make_unique<Recording>(options);
  if (const std::string fault = recording_->fault(); !fault.empty())
    throw app::Unavailable("cannot record into " + fault);
  app::log_info("recording into {}", path_.string());
  read_known_topics();
  look_for_topics();
  context.every(kLookPeriod, [this] { look_for_topics(); });
  context.every(kTakePeriod, [this] { take_all(); });
  context.every(kFlushPeriod, [this] { recording_->flush(); });
  context.before_report([this] { report(); });
  if (settings.duration_s > 0.0)
    context.after(std::chrono::duration_cast<std::chrono::nanoseconds>(
                      std::chrono::duration<double>(settings.duration_s)),
                  [this] { context_.stop(); });
}

/// The first samples of a topic may come before its writer has been looked at.
void RecorderService::read_known_topics() {
  for (const dds::TopicInfo* info : dds::topic_table()) {
    if (!topics_.contains(info->name)) continue;
    const bool is_kept =
        dds::qos_profile(info->flow).durability == dds::Durability::kTransientLocal;
    early_[std::string(info->name)] = std::make_unique<dds::RawReader>(
        context_.participant(), dds::RawTopic::of_table(*info),
        dds::OfferedQos{.is_transient_local = is_kept, .representation = kCdrVersion2});
  }
}

/// The reader that has been there, unless the writer is of another type or offers less.
std::unique_ptr<dds::RawReader> RecorderService::reader_of(
    const dds::FoundWriter& writer, std::shared_ptr<const dds::RawTopic> topic) {
  const auto early = early_.find(writer.topic_name);
  if (early != early_.end()) {
    std::unique_ptr<dds::RawReader> reader = std::move(early->second);
    early_.erase(early);
    if (reader->raw_topic().type() == topic->type() && reader->matched_writers() > 0) return reader;
  }
  return std::make_unique<dds::RawReader>(context_.participant(), std::move(topic), writer.qos);
}

void RecorderService::look_for_topics() {
  for (dds::FoundWriter& writer : discovery_.take()) {
    const bool is_wanted = topics_.contains(writer.topic_name);
    if (is_wanted && known_.emplace(writer.topic_name, writer.type_name).second)
      wanted_.push_back({std::move(writer)});
  }
  std::erase_if(wanted_, [this](Wanted& wanted) {
    if (try_to_read(wanted.writer)) return true;
    if (++wanted.attempts < kMostAttempts) return false;
    context_.warn(
        "topics_without_type",
        wanted.writer.topic_name + ": its writer does not describe its type: not recorded");
    known_.erase({wanted.writer.topic_name, wanted.writer.type_name});
    return true;
  });
}

/// False if the type is not described yet.
bool RecorderService::try_to_read(const dds::FoundWriter& writer) {
  if (!writer.information) return false;
  try {
    const auto topic = dds::RawTopic::resolve(context_.participant(), writer.topic_name,
                                              writer.type_name, *writer.information, kTypePatience);
    if (!topic) return false;
    auto reader = reader_of(writer, topic);
    inputs_.push_back(
        {std::move(reader), recording_->add(recordings::describe(*topic, writer.qos))});
  } catch (const dds::Error& error) {
    context_.warn("topics_refused", writer.topic_name + " is not recorded: " + error.what());
  }
  return true;
}

void RecorderService::take_all() {
  const std::int64_t this_look_ns = app::system_clock_ns();
  for (const Input& input : inputs_)
    input.reader->take_each([&](const dds::RawSample& sample) {
      batch_.add(input.channel, sample.source_time_ns, sample.cdr);
    });
  batch_.move_to(*recording_, last_look_ns_, this_look_ns);
  last_look_ns_ = this_look_ns;
}

RecorderService::~RecorderService() {
  try {
    finish();
  } catch (const dds::Error& error) { app::log_error("{}", error.what()); }
}

bool RecorderService::finish() {
  take_all();
  return recording_->finish();
}

void RecorderService::report() {
  std::map<std::string, std::uint64_t> totals = {{"messages", recording_->recorded()},
                                                 {"dropped_messages", recording_->dropped()},
                                                 {"bytes", recording_->bytes()},
                                                 {"topics", inputs_.size()},
                                                 {"lost_before_taken", 0},
                                                 {"topics_undescribed", wanted_.size()}};
  for (const Input& input : inputs_) {
    const dds::ReaderCounters counters = input.reader->counters();
    totals["lost_before_taken"] += counters.lost + counters.rejected;
    totals["incompatible_writers"] += input.reader->mismatch().value_or(dds::QosMismatch{}).total;
  }
  context_.status().set_counters(totals);
  const std::string fault = recording_->fault();
  if (fault.empty()) return;
  context_.status().set_trouble("recording", "recording has stopped: " + fault);
  if (ends_on_fault_) context_.stop(app::kExitFailure);
}

}  // namespace slammot::recorder
