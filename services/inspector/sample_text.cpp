#include "services/inspector/sample_text.hpp"

#include "common/dds/cdr_walk.hpp"

namespace slammot::inspector {
namespace {

/// "ranges_m" of "ranges_m[3]"; empty for what is no element of a list of numbers or texts.
std::string list_of(const std::string& path) {
  return path.ends_with(']') ? path.substr(0, path.rfind('[')) : std::string();
}

/// Puts the values of one list into one line.
class Lines {
 public:
  explicit Lines(std::size_t most) : most_(most) {}

  void add(const dds::CdrValue& value) {
    const std::string list = list_of(value.path);
    if (list.empty() || list != list_) end_list();
    if (list.empty()) {
      text_ += value.path + ": " + value.to_text() + "\n";
      return;
    }
    if (elements_ == 0) text_ += list + ": ";
    if (elements_ < most_) text_ += (elements_ == 0 ? "" : ", ") + value.to_text();
    list_ = list;
    ++elements_;
  }

  std::string text() {
    end_list();
    return std::move(text_);
  }

 private:
  void end_list() {
    if (elements_ > most_) text_ += ", ... (" + std::to_string(elements_) + ")";
    if (elements_ > 0) text_ += "\n";
    elements_ = 0;
    list_.clear();
  }

  std::size_t most_;
  std::string text_;
  std::string list_;
  std::size_t elements_ = 0;
};

}  // namespace

std::string sample_text(const dds::TypeModel& model, std::span<const std::uint8_t> cdr,
                        std::size_t most) {
  Lines lines(most);
  const bool is_whole =
      dds::for_each_value(model, cdr, [&](const dds::CdrValue& value) { lines.add(value); });
  return lines.text() + (is_whole ? "" : "(the rest cannot be read)\n");
}

}  // namespace slammot::inspector
