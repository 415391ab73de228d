#include "common/dds/reader_watch.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <dds/dds.h>

namespace slammot::dds {

bool ReaderWatch::has_new() {
  std::vector<dds_instance_handle_t> readers(known_.size() + 1);
  for (;;) {
    const dds_return_t count =
        dds_get_matched_subscriptions(writer_.handle(), readers.data(), readers.size());
    check(count, "dds_get_matched_subscriptions");
    const bool are_all = static_cast<std::size_t>(count) <= readers.size();
    readers.resize(static_cast<std::size_t>(count));
    if (are_all) break;
  }
  std::set<std::uint64_t> connected(readers.begin(), readers.end());
  const bool has_new = !std::ranges::includes(known_, connected);
  known_ = std::move(connected);
  return has_new;
}

}  // namespace slammot::dds
