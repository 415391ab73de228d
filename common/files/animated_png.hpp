#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/files/png_image.hpp"

namespace slammot::files {

/// Pictures of one size, shown one after another for the same time, for ever.
struct Animation {
  std::vector<RgbImage> frames;  ///< Not empty.
  std::uint16_t frame_ms = 100;
};

/// An animated PNG, which browsers play and other programs show as its first frame: "Portable
/// Network Graphics (PNG) Specification (Third Edition)", W3C 2025, section 11.3.6 (chunks acTL,
/// fcTL, fdAT). At most 256 colours are kept, the most frequent ones of all frames; of each frame
/// only the rectangle is written that differs from the one before.
std::string to_animated_png(const Animation& animation);

}  // namespace slammot::files
