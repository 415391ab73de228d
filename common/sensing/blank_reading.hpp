#pragma once

namespace slammot::sensing {

/// A reading that tells nothing, neither an echo nor free space: in any unit nearer than the least
/// range of any scanner.
inline constexpr float kTellsNothing = 1e-3F;

}  // namespace slammot::sensing
