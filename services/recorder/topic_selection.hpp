#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slammot::recorder {

/// Topics by name. A name that ends in '*' stands for all that begin like it.
class TopicSelection {
 public:
  /// Without names: all topics.
  explicit TopicSelection(std::vector<std::string> names = {}) : names_(std::move(names)) {}

  bool contains(std::string_view topic) const {
    if (names_.empty()) return true;
    for (const std::string& name : names_) {
      const bool is_prefix = name.ends_with('*');
      if (is_prefix ? topic.starts_with(std::string_view(name).substr(0, name.size() - 1))
                    : topic == name)
        return true;
    }
    return false;
  }

 private:
  std::vector<std::string> names_;
};

}  // namespace slammot::recorder
