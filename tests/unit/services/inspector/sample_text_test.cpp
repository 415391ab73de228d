#include "services/inspector/sample_text.hpp"

#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

using dds::TypeKind;

/// struct S { uint8 a; sequence<uint8> list; }, final.
dds::TypeModel model() {
  dds::NamedType type;
  type.kind = dds::NamedType::Kind::kStruct;
  type.name = "S";
  type.members.push_back({.name = "a", .type = {.kind = TypeKind::kByte}});
  type.members.push_back(
      {.name = "list",
       .type = {.kind = TypeKind::kSequence, .element = {{.kind = TypeKind::kByte}}}});
  return {{type}};
}

/// Version 1 of CDR, little endian.
const std::vector<std::uint8_t> kSample = {0, 1, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0, 1, 2, 3};

TEST(SampleText, HasALineForEachValueAndOneForAList) {
  EXPECT_EQ(sample_text(model(), kSample, 10), "a: 7\nlist.length: 3\nlist: 1, 2, 3\n");
}

TEST(SampleText, ShowsTheFirstElementsOfALongList) {
  EXPECT_EQ(sample_text(model(), kSample, 2), "a: 7\nlist.length: 3\nlist: 1, 2, ... (3)\n");
}

TEST(SampleText, SaysWhereASampleIsCut) {
  const std::vector<std::uint8_t> cut(kSample.begin(), kSample.end() - 1);
  EXPECT_EQ(sample_text(model(), cut, 10),
            "a: 7\nlist.length: 3\nlist: 1, 2\n(the rest cannot be read)\n");
}

}  // namespace
}  // namespace slammot::inspector
