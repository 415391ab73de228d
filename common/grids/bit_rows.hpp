#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace slammot::grids {

constexpr std::int32_t kCellsPerWord = 64;

/// Bit mask of a window's cells, with the range of used words of each row.
struct BitRows {
  std::int32_t words_per_row = 0;
  std::vector<std::uint64_t> words;
  std::vector<std::int32_t> first_word;  ///< Per row; first > last if the row is empty.
  std::vector<std::int32_t> last_word;

  BitRows() = default;
  BitRows(std::int32_t columns, std::int32_t rows)
      : words_per_row(columns / kCellsPerWord + 1),
        words(static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(rows), 0),
        first_word(static_cast<std::size_t>(rows), words_per_row),
        last_word(static_cast<std::size_t>(rows), -1) {}

  std::uint64_t* row(std::int32_t row) {
    return words.data() + static_cast<std::ptrdiff_t>(row) * words_per_row;
  }
  const std::uint64_t* row(std::int32_t row) const {
    return words.data() + static_cast<std::ptrdiff_t>(row) * words_per_row;
  }

  void use(std::int32_t row, std::int32_t word) {
    const auto at = static_cast<std::size_t>(row);
    first_word[at] = std::min(first_word[at], word);
    last_word[at] = std::max(last_word[at], word);
  }
  /// Calls take(row, word, bits) for each word with a set bit, and clears all bits.
  template <typename Take>
  void take_all(const Take& take) {
    for (std::size_t at = 0; at < first_word.size(); ++at) {
      const auto row = static_cast<std::int32_t>(at);
      std::uint64_t* const words_of_row = this->row(row);
      for (std::int32_t word = first_word[at]; word <= last_word[at]; ++word) {
        const std::uint64_t bits = std::exchange(words_of_row[word], 0);
        if (bits != 0) take(row, word, bits);
      }
      first_word[at] = words_per_row;
      last_word[at] = -1;
    }
  }
  void clear_all() {
    std::ranges::fill(words, 0);
    std::ranges::fill(first_word, words_per_row);
    std::ranges::fill(last_word, -1);
  }
  void flip(std::int32_t column, std::int32_t row) {
    use(row, column >> 6);
    this->row(row)[column >> 6] ^= std::uint64_t{1} << (column & 63);
  }
  void set(std::int32_t column, std::int32_t row) {
    use(row, column >> 6);
    this->row(row)[column >> 6] |= std::uint64_t{1} << (column & 63);
  }
  void clear(std::int32_t column, std::int32_t row) {
    this->row(row)[column >> 6] &= ~(std::uint64_t{1} << (column & 63));
  }
  bool is_set(std::int32_t column, std::int32_t row) const {
    return this->row(row)[column >> 6] >> (column & 63) & 1;
  }
};

}  // namespace slammot::grids
