#pragma once

#include <optional>
#include <string>

#include "common/files/png_image.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// The maps of a result as one picture for page/replay_scene.js.
struct ReportPicture {
  std::string png;  ///< Red: evidence of stationary objects + 128; green: share of motion.
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  double width_m = 0.0;
  double height_m = 0.0;
};

/// Empty without a map. Larger maps are reduced to at most 4096 pixels along a side, what browsers
/// take as a texture; of the pixels that become one, the most occupied and the most moving counts.
std::optional<ReportPicture> draw_picture(const RunResult& result);

/// Evidence of both maps in a palette: index `ground + 3 * motion`, where ground is 0 for unknown,
/// 1 for free and 2 for occupied, and motion is 0 to kMotionLevels - 1.
inline constexpr int kMotionLevels = 16;
files::IndexedImage joined_maps(const files::MapImage& map, const files::MapImage* moving,
                                std::uint32_t step);

}  // namespace slammot::evaluator
