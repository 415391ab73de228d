#include "common/files/base64.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

std::vector<std::uint8_t> bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Base64, IsThatOfTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(to_base64(bytes("f")), "Zg==");
  EXPECT_EQ(to_base64(bytes("fo")), "Zm8=");
  EXPECT_EQ(to_base64(bytes("foobar")), "Zm9vYmFy");
}

TEST(Base64, OfTextMatchesTheStandard) {
  EXPECT_EQ(to_base64(""), "");
  EXPECT_EQ(to_base64("f"), "Zg==");
  EXPECT_EQ(to_base64("fo"), "Zm8=");
  EXPECT_EQ(to_base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(to_base64("\xff\xfe"), "//4=");
}

TEST(Base64, ComesBack) {
  std::vector<std::uint8_t> all;
  for (int i = 0; i < 256; ++i) {
    EXPECT_EQ(from_base64(to_base64(all)), all);
    all.push_back(static_cast<std::uint8_t>(i * 37));
  }
}

TEST(Base64, OtherTextIsNone) {
  for (const char* text : {"Zg=", "Z===", "Zm9?", "Zg==Zg==", "=AAA", "AA=A"})
    EXPECT_FALSE(from_base64(text)) << text;
}

}  // namespace
}  // namespace slammot::files
