#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/dds/type_model.hpp"

namespace slammot::inspector {

/// The values of a sample, a line each: "base_from_laser.x_m: 1.25". Numbers of one list share a
/// line: "ranges_m: 8.1, 8.2, ... (361)"; of a longer one the first `most` are shown. Ends with a
/// remark where the bytes end before the sample does.
std::string sample_text(const dds::TypeModel& model, std::span<const std::uint8_t> cdr,
                        std::size_t most);

}  // namespace slammot::inspector
