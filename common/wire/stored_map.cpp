#include "common/wire/stored_map.hpp"

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {

slammot_StoredMap encode(std::string_view vehicle_id, const flow::StoredMap& map) {
  slammot_StoredMap sample{};
  set_text(sample.vehicle_id, vehicle_id);
  sample.map_id = map.map_id.value;
  sample.submap_count = map.submaps;
  sample.unreadable_count = map.unreadable;
  sample.last_submap_id = map.last_submap_id.value;
  sample.cell_size_m = map.cell_size_m;
  return sample;
}

Decoded<flow::StoredMap> decode(const slammot_StoredMap& sample) {
  if (!is_amount(sample.cell_size_m)) return Fault{"cell_size_m is negative or not finite"};
  const std::uint64_t numbers = std::uint64_t{sample.last_submap_id} + 1;
  if (std::uint64_t{sample.submap_count} + sample.unreadable_count > numbers)
    return Fault{"there are more submaps than numbers"};
  return flow::StoredMap{{sample.map_id},
                         sample.submap_count,
                         sample.unreadable_count,
                         {sample.last_submap_id},
                         sample.cell_size_m};
}

}  // namespace slammot::wire
