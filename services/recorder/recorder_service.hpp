#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/dds/raw_reader.hpp"
#include "common/dds/topic_discovery.hpp"
#include "services/recorder/recording.hpp"
#include "services/recorder/sample_batch.hpp"
#include "services/recorder/topic_selection.hpp"

namespace slammot::recorder {

/// Records topics of the bus into an MCAP file, whatever their types.
class RecorderService {
 public:
  struct Settings {
    std::string output;  ///< Empty: a name with the vehicle and the time, in the state folder.
    std::vector<std::string> topics = {};  ///< As TopicSelection has them.
    std::string compression = "zstd";
    double duration_s = 0.0;  ///< Ends after so long; 0: when it is stopped.
    bool ends_on_fault = false;
    RecordingOptions recording = {};  ///< Path, compression and attachments are set here.
  };
  static constexpr const char* kName = "recorder";
  static constexpr const char* kPurpose = "Records topics of the bus into an MCAP file.";
  static constexpr bool kGivesWay = true;
  static std::vector<config::BoundStage> stages(Settings&) { return {}; }
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws StartupFailure if the file exists, Unavailable if it cannot be made.
  RecorderService(app::ServiceContext& context, const Settings& settings);
  ~RecorderService();
  RecorderService(const RecorderService&) = delete;
  RecorderService& operator=(const RecorderService&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const Recording& recording() const { return *recording_; }
  std::size_t topic_count() const { return inputs_.size(); }
  /// Ends the file; called by the destructor, too. False if a part was lost.
  bool finish();

 private:
  struct Input {
    std::unique_ptr<dds::RawReader> reader;
    mcap::ChannelId channel;
  };
  struct Wanted {
    dds::FoundWriter writer;
    int attempts = 0;
  };
  using TopicKey = std::pair<std::string, std::string>;  ///< Topic and type.

  void read_known_topics();
  std::unique_ptr<dds::RawReader> reader_of(const dds::FoundWriter& writer,
                                            std::shared_ptr<const dds::RawTopic> topic);
  void look_for_topics();
  bool try_to_read(const dds::FoundWriter& writer);
  void take_all();
  void report();

  app::ServiceContext& context_;
  TopicSelection topics_;
  bool ends_on_fault_;
  std::filesystem::path path_;
  std::unique_ptr<Recording> recording_;
  dds::TopicDiscovery discovery_;
  std::set<TopicKey> known_;
  std::vector<Wanted> wanted_;  ///< Found, but not described yet.
  /// By topic: readers of topics whose writers have not been found. What they have is kept.
  std::map<std::string, std::unique_ptr<dds::RawReader>> early_;
  std::vector<Input> inputs_;
  SampleBatch batch_;
  std::int64_t last_look_ns_;
};

}  // namespace slammot::recorder
