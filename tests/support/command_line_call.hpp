#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/slammot/command_line.hpp"

namespace slammot::testing {

struct Outcome {
  int exit_code = 0;
  std::string standard_output;
  std::string standard_error;
};

/// Runs `slammot WORDS...` in this process and captures what it prints.
inline Outcome call(std::vector<std::string> words) {
  words.insert(words.begin(), "slammot");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = run_command_line(static_cast<int>(argv.size()), argv.data());
  std::fflush(stdout);
  outcome.standard_output = ::testing::internal::GetCapturedStdout();
  outcome.standard_error = ::testing::internal::GetCapturedStderr();
  return outcome;
}

}  // namespace slammot::testing
