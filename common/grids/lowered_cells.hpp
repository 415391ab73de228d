#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace slammot::grids {

/// Table: for each 8-bit pattern, a mask with one byte (0 or 0xff) per bit.
inline constexpr auto kMaskOfBits = [] {
  std::array<std::uint64_t, 256> masks{};
  for (std::size_t bits = 0; bits < masks.size(); ++bits) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t bit = 0; bit < 8; ++bit)
      bytes[bit] = bits >> bit & 1 ? std::uint8_t{0xff} : std::uint8_t{0};
    masks[bits] = std::bit_cast<std::uint64_t>(bytes);
  }
  return masks;
}();

/// The inverse: one bit for each 0xff byte, gathered into the top byte by a multiplication.
constexpr std::uint64_t bits_of_mask(std::uint64_t mask) {
  return ((mask & 0x0101010101010101) * 0x0102040810204080) >> 56;
}

/// Lowers the selected ones of up to 64 cells by this many steps, not below the lowest value unless
/// a cell is already below it. It uses masks, so that the time does not depend on the pattern.
/// Cells are shifted by 128 to unsigned, because every x86-64 has a maximum of unsigned bytes.
/// Returns a bit for each selected cell that is at its lowest value, and possibly for further such
/// cells.
inline std::uint64_t lower_cells(std::int8_t* cells, std::int32_t count, std::uint64_t bits,
                                 int steps_down, int lowest_steps) {
  // Sixteen cells in one register, on every processor with GCC and Clang; auto-vectorization of a
  // loop over bytes is unreliable.
  using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
  using TwoMasks [[gnu::vector_size(16)]] = std::uint64_t;
  constexpr std::int32_t kCellsPerRegister = 16;
  constexpr std::uint8_t kHigher = 0x80;
  const auto step = static_cast<std::int8_t>(steps_down);
  const auto lowest = static_cast<std::int8_t>(lowest_steps + steps_down);  // before the step
  const Bytes steps = Bytes{} + static_cast<std::uint8_t>(step);
  const Bytes lowest_higher =
      Bytes{} + static_cast<std::uint8_t>(static_cast<std::uint8_t>(lowest) ^ kHigher);
  const Bytes lowest_of_all = lowest_higher - steps;
  std::uint64_t cannot_be_lowered = 0;
  std::int32_t first = 0;
  for (; first + kCellsPerRegister <= count; first += kCellsPerRegister) {
    if ((bits >> first & 0xffff) == 0) continue;
    const Bytes mask = std::bit_cast<Bytes>(
        TwoMasks{kMaskOfBits[bits >> first & 0xff], kMaskOfBits[bits >> (first + 8) & 0xff]});
    Bytes higher;
    std::memcpy(&higher, cells + first, sizeof higher);
    higher ^= kHigher;
    const Bytes least = lowest_higher & mask;
    const Bytes lowered = (higher > least ? higher : least) - (steps & mask);
    higher = lowered < higher ? lowered : higher;
    const auto at_lowest = std::bit_cast<TwoMasks>(higher <= lowest_of_all);
    cannot_be_lowered |= (bits_of_mask(at_lowest[0]) | bits_of_mask(at_lowest[1]) << 8) << first;
    higher ^= kHigher;
    std::memcpy(cells + first, &higher, sizeof higher);
  }
  for (; first < count; ++first) {
    if (bits >> first & 1)
      cells[first] =
          std::min(cells[first], static_cast<std::int8_t>(std::max(cells[first], lowest) - step));
    cannot_be_lowered |= std::uint64_t{cells[first] <= lowest_steps} << first;
  }
  return cannot_be_lowered;
}

}  // namespace slammot::grids
