#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::testing {

inline std::size_t below(std::size_t limit, std::mt19937& random) {
  return limit == 0 ? 0 : random() % limit;
}

/// Any bytes at all.
inline std::string random_bytes(std::size_t most, std::mt19937& random) {
  std::string bytes(below(most + 1, random), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

/// Words from a list in random order: gets deeper into a parser than any bytes do.
inline std::string random_words(const std::vector<std::string_view>& words, std::size_t most,
                                std::mt19937& random) {
  std::string text;
  for (std::size_t count = below(most + 1, random); count > 0; --count) {
    text += words[below(words.size(), random)];
    text += random() % 8 == 0 ? "\n" : " ";
  }
  return text;
}

/// The bytes with a few things done to them: bits flipped, pieces left out, doubled, swapped for
/// words of the list.
inline std::string mutated(std::string bytes, const std::vector<std::string_view>& words,
                           std::mt19937& random) {
  for (std::size_t changes = 1 + below(8, random); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t place = below(bytes.size(), random);
    const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - place, 40), random);
    switch (random() % 5) {
      case 0: bytes[place] = static_cast<char>(bytes[place] ^ (1 << random() % 8)); break;
      case 1: bytes[place] = static_cast<char>(random()); break;
      case 2: bytes.erase(place, length); break;
      case 3: bytes.insert(below(bytes.size(), random), bytes.substr(place, length)); break;
      default:
        if (!words.empty())
          bytes.replace(place, std::min<std::size_t>(length, 8),
                        words[below(words.size(), random)]);
    }
  }
  return bytes;
}

}  // namespace slammot::testing
