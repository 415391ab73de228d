#include "services/evaluator/table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::EndsWith;

class TableFile : public ::testing::Test {
 protected:
  std::string fault_of(const std::string& text) {
    write(folder_ / "table.csv", text);
    const auto fault = read_csv(folder_ / "table.csv", {"b", "a"}, [&](auto fields) -> RowFault {
      const auto row = numbers(fields);
      if (!row) return "no number";
      last_ = *row;
      return std::nullopt;
    });
    return fault ? fault->message : "";
  }

  testing::TemporaryFolder folder_;
  std::vector<double> last_;
};

TEST_F(TableFile, PassesColumnsByName) {
  EXPECT_EQ(fault_of("a,x,b\n1,2,3\n"), "");
  EXPECT_EQ(last_, (std::vector<double>{3.0, 1.0}));
}

TEST_F(TableFile, NamesTheLineOfAMalformedRow) {
  EXPECT_THAT(fault_of("a,b\n1,2\n1,x\n"), EndsWith("table.csv:3: no number"));
  EXPECT_THAT(fault_of("a,b\n1,2,3\n"), EndsWith("table.csv:2: 3 fields where the header has 2"));
  EXPECT_THAT(fault_of("a,b\n1,nan\n"), EndsWith("table.csv:2: no number"));
}

TEST_F(TableFile, ReportsAMissingColumn) {
  EXPECT_THAT(fault_of("a,c\n1,2\n"), EndsWith("table.csv:1: no column b"));
}

TEST_F(TableFile, ReadsCarriageReturns) { EXPECT_EQ(fault_of("a,b\r\n1,2\r\n"), ""); }

}  // namespace
}  // namespace slammot::evaluator
