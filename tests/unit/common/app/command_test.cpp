#include "common/app/command.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

TEST(CommandDesk, DoesWhatIsAskedWithItsArgument) {
  CommandDesk desk;
  desk.on("say", [](std::string_view argument) {
    return CommandResult{CommandOutcome::kRefused, "not " + std::string(argument)};
  });
  const CommandResult result = desk.answer({"me", 1, "say", "hello"});
  EXPECT_EQ(result.outcome, CommandOutcome::kRefused);
  EXPECT_EQ(result.explanation, "not hello");
}

TEST(CommandDesk, DoesNotKnowWhatItWasNotTaught) {
  CommandDesk desk;
  const CommandResult result = desk.answer({"me", 1, "fly", ""});
  EXPECT_EQ(result.outcome, CommandOutcome::kUnknownVerb);
  EXPECT_EQ(result.explanation, "unknown command 'fly'");
}

TEST(CommandDesk, AnswersARepeatedRequestWithoutDoingItAgain) {
  CommandDesk desk;
  int done = 0;
  desk.on("count", [&](std::string_view) {
    return CommandResult{CommandOutcome::kDone, std::to_string(++done)};
  });
  EXPECT_EQ(desk.answer({"me", 1, "count", ""}).explanation, "1");
  EXPECT_EQ(desk.answer({"me", 1, "count", ""}).explanation, "1");
  EXPECT_EQ(desk.answer({"you", 1, "count", ""}).explanation, "2");
  EXPECT_EQ(desk.answer({"me", 2, "count", ""}).explanation, "3");
}

}  // namespace
}  // namespace slammot::app
