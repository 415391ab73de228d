#include "common/bags/bag.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "common/bags/byte_source.hpp"
#include "common/bags/db3_reader.hpp"
#include "common/bags/mcap_reader.hpp"
#include "common/bags/ros1_bag_reader.hpp"
#include "common/bags/unpack.hpp"

namespace slammot::bags {
namespace {

constexpr std::int64_t kMostTime_ns = 9'000'000'000'000'000'000;  // differences of two times fit
                                                                  // into 64 bits
constexpr std::size_t kMostMessageBytes = std::size_t{64} << 20;

enum class Form : std::uint8_t { kNone, kRos1, kRos1Old, kMcap, kDb3 };

Form form_of(std::string_view begin) {
  if (begin.starts_with(Ros1BagReader::kMagic)) return Form::kRos1;
  if (begin.starts_with("#ROSBAG V")) return Form::kRos1Old;
  if (begin.starts_with("\x89MCAP0\r\n")) return Form::kMcap;
  if (begin.starts_with("SQLite format 3")) return Form::kDb3;
  return Form::kNone;
}

Form form_of_file(const std::filesystem::path& path) {
  constexpr std::size_t kEnough = 16;
  const std::string begin = first_bytes(path, kEnough);
  if (!is_zstd(begin)) return form_of(begin);
  std::vector<std::uint8_t> unpacked;
  ByteSource(path).read(kEnough, unpacked);
  return form_of(text_of(unpacked));
}

/// True if a file without a bag's magic bytes is meant to be a bag.
bool is_named_as_bag(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  if (name.ends_with(".zstd")) name.resize(name.size() - std::string_view(".zstd").size());
  return name.ends_with(".bag") || name.ends_with(".mcap") || name.ends_with(".db3");
}

/// Natural order of names: drive_2 before drive_10.
bool comes_before(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number_at = [&](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return std::pair(at - begin, text.substr(begin, at - begin));
    };
    const auto number_a = number_at(a, i);
    const auto number_b = number_at(b, j);
    if (number_a != number_b) return number_a < number_b;
  }
  return a.size() - i < b.size() - j;
}

/// The bag's files in order, all of one format.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::pair<Form, std::filesystem::path>> found;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    const Form form = form_of_file(entry->path());
    if (form != Form::kNone) found.emplace_back(form, entry->path());
  }
  std::vector<std::filesystem::path> files;
  for (const Form form : {Form::kMcap, Form::kDb3, Form::kRos1, Form::kRos1Old}) {
    for (const auto& [its_form, path] : found) {
      if (its_form == form) files.push_back(path);
    }
    if (!files.empty()) break;
  }
  // An unpacked file beside its compressed form has the same content.
  std::erase_if(files, [&](const std::filesystem::path& path) {
    return path.extension() == ".zstd" &&
           std::ranges::find(files, std::filesystem::path(path).replace_extension()) != files.end();
  });
  std::ranges::sort(files, [](const auto& a, const auto& b) {
    return comes_before(a.filename().string(), b.filename().string());
  });
  return files;
}

OpenedBag open_file(const std::filesystem::path& path) {
  switch (form_of_file(path)) {
    case Form::kNone:
      return {nullptr,
              path.string() +
                  ": it does not begin as a bag of ROS does; it is damaged or something else"};
    case Form::kRos1Old:
      return {nullptr,
              path.string() + ": a bag of ROS 1 of an old version: rosbag migrate makes 2.0 of it"};
    case Form::kDb3: return {std::make_unique<Db3Reader>(path), {}};
    default: break;
  }
  ByteSource file(path);
  if (!file.is_open()) return {nullptr, path.string() + ": it cannot be opened"};
  if (form_of_file(path) == Form::kMcap) return {std::make_unique<McapReader>(std::move(file)), {}};
  return {std::make_unique<Ros1BagReader>(std::move(file)), {}};
}

/// The files of a bag in sequence, with compressed messages unpacked.
class Bag : public MessageSource {
 public:
  explicit Bag(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}

  std::optional<RawMessage> next() override {
    while (true) {
      if (!now_) {
        if (opened_ == files_.size()) return std::nullopt;
        auto opened = open_file(files_[opened_++]);
        if (!opened.messages) {
          note(opened.fault);
          continue;
        }
        now_ = std::move(opened.messages);
      }
      auto message = now_->next();
      if (message) {
        message->log_time_ns = std::clamp(message->log_time_ns, std::int64_t{0}, kMostTime_ns);
        return unpacked(*message);
      }
      note_damage();
      if (opened_ == files_.size()) return std::nullopt;
      past_.push_back(std::exchange(now_, nullptr));  // its channels are still referenced
    }
  }

  double fraction_read() const override {
    const double of_now = now_ ? now_->fraction_read() : 0.0;
    const std::size_t before = opened_ - (now_ ? 1 : 0);
    return files_.empty()
               ? 1.0
               : (static_cast<double>(before) + of_now) / static_cast<double>(files_.size());
  }

  std::string damage() const override { return damage_; }

 private:
  void note(const std::string& damage) {
    if (damage_.empty()) damage_ = damage;
  }

  void note_damage() {
    const std::string damage = now_->damage();
    if (!damage.empty())
      note(files_.size() > 1 ? files_[opened_ - 1].filename().string() + ": " + damage : damage);
  }

  /// A CDR message begins with 0; a compressed one does not.
  RawMessage unpacked(RawMessage message) {
    if (message.channel->serialization != Serialization::kCdr ||
        !is_zstd(text_of(message.bytes.first(std::min<std::size_t>(4, message.bytes.size())))))
      return message;
    Unpacked plain = unpack("zstd", message.bytes, kMostMessageBytes);
    if (!plain.is_whole) note("a message of " + message.channel->topic + " does not unpack");
    message_ = std::move(plain.bytes);
    message.bytes = message_;
    return message;
  }

  std::vector<std::filesystem::path> files_;
  std::size_t opened_ = 0;
  std::unique_ptr<MessageSource> now_;
  std::vector<std::unique_ptr<MessageSource>> past_;
  std::vector<std::uint8_t> message_;
  std::string damage_;
};

}  // namespace

bool is_bag(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return !files_of(path).empty();
  return std::filesystem::is_regular_file(path, ignored) &&
         (form_of_file(path) != Form::kNone || is_named_as_bag(path) ||
          is_zstd(first_bytes(path, 4)));
}

OpenedBag open_bag(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    std::vector<std::filesystem::path> files = files_of(path);
    if (files.empty()) return {nullptr, path.string() + ": the folder holds no bag"};
    return {std::make_unique<Bag>(std::move(files)), {}};
  }
  auto first = open_file(path);
  if (!first.messages) return first;
  return {std::make_unique<Bag>(std::vector{path}), {}};
}

}  // namespace slammot::bags
