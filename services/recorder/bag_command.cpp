#include "services/recorder/bag_command.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/files/decimal.hpp"
#include "common/files/failure.hpp"
#include "common/files/number_option.hpp"
#include "services/recorder/bag_files.hpp"

namespace slammot::recorder {
namespace {

constexpr int kDone = 0;
constexpr int kMostFiles = 1000;
constexpr int kDamaged = 3;  ///< As `run` reports a log that is cut.

struct BagOptions {
  std::vector<std::string> files;
  std::string output;
  double from_s = 0.0;
  double duration_s = 0.0;
  std::vector<std::string> topics;
  std::string compression = "zstd";
};

int say_damage(const mcap::File& file) {
  for (const std::string& damage : file.contents().damage)
    std::fprintf(stderr, "slammot: %s\n", damage.c_str());
  return file.contents().damage.empty() ? kDone : kDamaged;
}

int info(const BagOptions& options) {
  const auto file = mcap::File::open(options.files.front());
  if (!file) return files::fail(file.error().message);
  const mcap::Contents& contents = file->contents();
  const mcap::Statistics& statistics = contents.statistics;
  std::printf("written by %s\n", contents.header.library.c_str());
  std::printf("%.1f s, %llu messages, %.1f MB in %zu chunks\n",
              static_cast<double>(statistics.end_ns - statistics.start_ns) * 1e-9,
              static_cast<unsigned long long>(statistics.message_count),
              static_cast<double>(file->size_bytes()) * 1e-6, contents.chunks.size());
  for (const auto& [id, channel] : contents.channels) {
    const auto schema = contents.schemas.find(channel.schema_id);
    const auto count = statistics.messages_of.find(id);
    std::printf(
        "%9llu  %s  %s\n",
        count == statistics.messages_of.end() ? 0ULL
                                              : static_cast<unsigned long long>(count->second),
        channel.topic.c_str(), schema == contents.schemas.end() ? "" : schema->second.name.c_str());
  }
  for (const mcap::AttachmentIndex& attachment : contents.attachments)
    std::printf("attachment %s, %llu bytes\n", attachment.name.c_str(),
                static_cast<unsigned long long>(attachment.data_bytes));
  return say_damage(*file);
}

int verify(const BagOptions& options) {
  const auto file = mcap::File::open_and_verify(options.files.front());
  if (!file) return files::fail(file.error().message);
  const int exit_code = say_damage(*file);
  if (exit_code == kDone)
    std::printf("sound: %llu messages\n",
                static_cast<unsigned long long>(file->contents().statistics.message_count));
  return exit_code;
}

int say(const WrittenBag& written, const std::string& output) {
  if (!written.fault.empty()) return files::fail(written.fault);
  if (written.messages == 0) std::fprintf(stderr, "slammot: %s has no message\n", output.c_str());
  std::printf("%s: %llu messages\n", output.c_str(),
              static_cast<unsigned long long>(written.messages));
  return kDone;
}

int recover(const BagOptions& options) {
  const auto file = mcap::File::open_and_verify(options.files.front());
  if (!file) return files::fail(file.error().message);
  say_damage(*file);
  return say(recover_bag(*file, options.output), options.output);
}

int write(const std::vector<const mcap::File*>& files, const BagSelection& selection,
          const BagOptions& options) {
  const auto compression = mcap::compression_of(options.compression);
  return say(
      write_bag(files, selection, options.output, compression.value_or(mcap::Compression::kZstd)),
      options.output);
}

std::int64_t nanoseconds_of(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

BagSelection selection_of(const BagOptions& options, std::int64_t start_ns) {
  BagSelection selection{TopicSelection(options.topics)};
  if (options.from_s > 0.0) selection.from_ns = start_ns + nanoseconds_of(options.from_s);
  if (options.duration_s > 0.0)
    selection.to_ns = start_ns + nanoseconds_of(options.from_s + options.duration_s);
  return selection;
}

/// What is selected and not in the file.
std::optional<std::string> find_fault_of_selection(const BagOptions& options,
                                                   const mcap::Contents& contents) {
  for (const std::string& name : options.topics) {
    const TopicSelection topics({name});
    if (std::ranges::none_of(contents.channels, [&](const auto& channel) {
          return topics.contains(channel.second.topic);
        }))
      return "no topic is called '" + name + "'; slammot bag info lists them";
  }
  const std::int64_t length_ns = contents.statistics.end_ns - contents.statistics.start_ns;
  if (nanoseconds_of(options.from_s) <= length_ns) return std::nullopt;
  return "--from is beyond the end: the recording is " +
         files::fixed_text(static_cast<double>(length_ns) * 1e-9, 1) + " s long";
}

int cut(const BagOptions& options) {
  const auto file = mcap::File::open(options.files.front());
  if (!file) return files::fail(file.error().message);
  say_damage(*file);
  if (const auto fault = find_fault_of_selection(options, file->contents()))
    return files::fail(options.files.front() + ": " + *fault);
  return write({&*file}, selection_of(options, file->contents().statistics.start_ns), options);
}

int merge(const BagOptions& options) {
  std::vector<mcap::File> files;
  std::vector<const mcap::File*> pointers;
  for (const std::string& path : options.files) {
    auto file = mcap::File::open(path);
    if (!file) return files::fail(file.error().message);
    say_damage(*file);
    files.push_back(std::move(*file));
  }
  for (const mcap::File& file : files) pointers.push_back(&file);
  return write(pointers, {}, options);
}

CLI::App& add_part(CLI::App& bag, const char* name, const char* purpose, BagOptions& options,
                   int& exit_code, const std::shared_ptr<BagOptions>& owner,
                   int (*run)(const BagOptions&)) {
  CLI::App* const part = bag.add_subcommand(name, purpose);
  part->add_option("file", options.files, "MCAP file")->required()->expected(1)->type_name("FILE");
  part->callback([owner, run, &exit_code] { exit_code = run(*owner); });
  return *part;
}

void add_output(CLI::App& part, BagOptions& options) {
  part.add_option("--output", options.output, "File to write")->required()->type_name("FILE");
}

void add_compression(CLI::App& part, BagOptions& options) {
  part.add_option("--compression", options.compression, "Of chunks: none, lz4 or zstd")
      ->check(CLI::IsMember({"none", "lz4", "zstd"}))
      ->capture_default_str();
}

}  // namespace

void add_bag_command(CLI::App& app, int& exit_code) {
  CLI::App* const bag = app.add_subcommand("bag", "Look at and edit MCAP files");
  bag->require_subcommand(1);
  const auto options = std::make_shared<BagOptions>();
  const auto add = [&](const char* name, const char* purpose,
                       int (*run)(const BagOptions&)) -> CLI::App& {
    return add_part(*bag, name, purpose, *options, exit_code, options, run);
  };
  add("info", "Topics, types, counts and duration", info);
  add("verify", "Read everything and compare all checksums and indexes", verify);
  CLI::App& recovered =
      add("recover", "Give a cut or damaged file an end and indexes, with all its sound chunks",
          recover);
  add_output(recovered, *options);
  CLI::App& part = add("cut", "Copy a part of the time, or some topics", cut);
  add_output(part, *options);
  add_compression(part, *options);
  part.add_option("--from", options->from_s, "Seconds after the start")
      ->check(files::seconds_option());
  part.add_option("--duration", options->duration_s, "Seconds; 0: to the end")
      ->check(files::seconds_option());
  part.add_option("--topics", options->topics,
                  "Comma-separated; a trailing '*' stands for all "
                  "that begin like it")
      ->type_name("NAME,...")
      ->delimiter(',');
  CLI::App& merged = add("merge", "Join files by their log times", merge);
  merged.get_option("file")->description("Two or more MCAP files")->expected(2, kMostFiles);
  add_output(merged, *options);
  add_compression(merged, *options);
}

}  // namespace slammot::recorder
