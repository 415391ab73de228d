#pragma once

#include "common/files/ply_file.hpp"
#include "common/metrics/trajectory.hpp"
#include "services/evaluator/drawing.hpp"
#include "services/evaluator/page_theme.hpp"

namespace slammot::evaluator {

/// A model of facades seen from above at a slant, in parallel projection, with the way driven; at
/// most so many pixels along its longer side.
Drawing draw_model(const files::PlyModel& model, const metrics::Trajectory& way,
                   const PageTheme& theme, double most_pixels);

}  // namespace slammot::evaluator
