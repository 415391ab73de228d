#include "services/recorder/bag_files.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "common/mcap/message_cursor.hpp"
#include "common/mcap/stream_writer.hpp"

namespace slammot::recorder {
namespace {

/// One of the files, with its channels' ids in the output.
struct Source {
  const mcap::File* file;
  std::unique_ptr<mcap::MessageCursor> cursor;
  std::optional<mcap::Message> next;
  std::map<mcap::ChannelId, mcap::ChannelId> ids;
};

template <typename Writer>
void copy_parts(const mcap::File& file, Writer& writer) {
  for (const mcap::MetadataIndex& index : file.contents().metadata) {
    if (const auto metadata = file.metadata(index)) writer.write(*metadata);
  }
  for (const mcap::AttachmentIndex& index : file.contents().attachments) {
    if (const auto attachment = file.attachment(index)) writer.write(*attachment);
  }
}

Source source_of(const mcap::File& file, const BagSelection& selection,
                 mcap::StreamWriter& writer) {
  Source source{&file, nullptr, std::nullopt, {}};
  mcap::Selection wanted{{}, selection.from_ns, selection.to_ns};
  for (const auto& [id, channel] : file.contents().channels) {
    if (!selection.topics.contains(channel.topic)) continue;
    wanted.topics.insert(channel.topic);
    mcap::Channel copy = channel;
    const auto schema = file.contents().schemas.find(channel.schema_id);
    copy.schema_id =
        schema == file.contents().schemas.end() ? mcap::SchemaId{0} : writer.add(schema->second);
    source.ids[id] = writer.add(copy);
  }
  if (wanted.topics.empty()) return source;
  source.cursor = std::make_unique<mcap::MessageCursor>(file, std::move(wanted));
  source.next = source.cursor->next();
  return source;
}

/// The one with the earliest message; null at the end.
Source* earliest(std::vector<Source>& sources) {
  Source* first = nullptr;
  for (Source& source : sources) {
    if (!source.next) continue;
    if (first == nullptr || source.next->head.log_time_ns < first->next->head.log_time_ns)
      first = &source;
  }
  return first;
}

}  // namespace

WrittenBag write_bag(const std::vector<const mcap::File*>& files, const BagSelection& selection,
                     const std::filesystem::path& output, mcap::Compression compression) {
  mcap::StreamWriter writer(output, files.front()->contents().header, compression);
  if (!writer.fault().empty()) return {0, writer.fault()};
  std::vector<Source> sources;
  for (const mcap::File* file : files) {
    copy_parts(*file, writer);
    sources.push_back(source_of(*file, selection, writer));
  }
  WrittenBag written;
  while (Source* const source = earliest(sources)) {
    mcap::MessageHead head = source->next->head;
    head.channel_id = source->ids.at(head.channel_id);
    if (!writer.add(head, source->next->data)) break;
    ++written.messages;
    source->next = source->cursor->next();
  }
  if (!writer.finish()) written.fault = writer.fault();
  return written;
}

WrittenBag recover_bag(const mcap::File& file, const std::filesystem::path& output) {
  mcap::FileSink sink(output);
  mcap::Writer writer(sink, file.contents().header, mcap::Compression::kNone);
  copy_parts(file, writer);
  for (const auto& [id, schema] : file.contents().schemas) writer.know(schema);
  for (const auto& [id, channel] : file.contents().channels) writer.know(channel);
  for (const mcap::ChunkIndex& chunk : file.contents().chunks)
    writer.write_packed(file.chunk_record(chunk), chunk,
                        mcap::indexes_of(file.chunk(chunk).records));
  WrittenBag written{writer.statistics().message_count, {}};
  const bool is_whole = writer.finish() && sink.close();
  if (!is_whole || !writer.fault().empty())
    written.fault = writer.fault().empty() ? sink.fault() : writer.fault();
  return written;
}

}  // namespace slammot::recorder
