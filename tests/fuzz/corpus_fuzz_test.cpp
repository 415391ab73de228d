#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/fuzz/mutation.hpp"
#include "tests/fuzz/targets.hpp"

namespace slammot::fuzz {
namespace {

std::vector<std::string> corpus_of(std::string_view target) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(SLAMMOT_FUZZ_CORPUS) / target))
    files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<std::string> corpus;
  for (const auto& file : files) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    corpus.push_back(bytes.str());
  }
  return corpus;
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, IsRead) {
  const auto corpus = corpus_of(GetParam().name);
  ASSERT_FALSE(corpus.empty());
  for (const std::string& bytes : corpus) GetParam().read(bytes);
}

TEST_P(Corpus, IsReadWhateverHappensToIt) {
  constexpr int kInputs = 1000;
  std::mt19937 random(1);
  const auto corpus = corpus_of(GetParam().name);
  ASSERT_FALSE(corpus.empty());
  for (int i = 0; i < kInputs; ++i) {
    const std::string& whole = corpus[testing::below(corpus.size(), random)];
    std::string damaged = testing::mutated(whole, {}, random);
    if (i % 4 == 0) damaged.resize(testing::below(damaged.size() + 1, random));
    GetParam().read(damaged);
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, ::testing::ValuesIn(kTargets),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace slammot::fuzz
