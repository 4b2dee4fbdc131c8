// Structs of an older and a newer header than the library's own.
#include "bindings/c/versioned_struct.h"
#include "tests/support/message_of_error.h"

#include <gtest/gtest.h>

#include <string>

namespace weir::c {
namespace {

/// As the first version had it, as the library knows it, and as a later one will.
struct First {
  std::size_t struct_size;
  int a;
  int b;
};
struct Known {
  std::size_t struct_size;
  int a;
  int b;
  double c;
};
struct Later {
  std::size_t struct_size;
  int a;
  int b;
  double c;
  int d[4];
};

}  // namespace

template <>
inline constexpr std::size_t kFirstBytes<Known> = sizeof(First);

namespace {

template <typename Given>
Known read(const Given& given) {
  return read_struct(reinterpret_cast<const Known*>(&given), "weir_known");
}

template <typename Given>
std::string refusal(const Given& given) {
  return message_of_error(ErrorKind::usage, [&] { read(given); });
}

TEST(VersionedStruct, OlderStruct_IsReadAndNotWrittenBeyondItsSize) {
  struct {
    First first{};
    int beyond = 99;
  } older;
  auto* const known = reinterpret_cast<Known*>(&older.first);
  EXPECT_EQ(init_struct(known, sizeof older.first), WEIR_OK);
  EXPECT_EQ(older.beyond, 99);
  older.first.a = 3;
  EXPECT_EQ(read(older.first).a, 3);
  EXPECT_EQ(read(older.first).c, 0);
  write_struct(Known{0, 4, 5, 6.0}, known);
  EXPECT_EQ(older.first.struct_size, sizeof(First));
  EXPECT_EQ(older.first.b, 5);
  EXPECT_EQ(older.beyond, 99);
}

TEST(VersionedStruct, NewerStruct_IsReadUnlessItsNewMembersAreSet) {
  Later later{};
  EXPECT_EQ(init_struct(reinterpret_cast<Known*>(&later), sizeof later), WEIR_OK);
  EXPECT_EQ(later.struct_size, sizeof later);
  later.c = 2.5;
  EXPECT_EQ(read(later).c, 2.5);
  write_struct(Known{0, 4, 5, 6.0}, reinterpret_cast<Known*>(&later));
  EXPECT_EQ(later.struct_size, sizeof later);
  EXPECT_EQ(later.c, 6.0);
  later.d[3] = 1;
  EXPECT_EQ(refusal(later),
            "weir_known: sets members that are newer than this library, " WEIR_VERSION "; leave them 0");
}

TEST(VersionedStruct, WrongStructSize_IsRefused) {
  First first{sizeof(First) - 1, 0, 0};
  EXPECT_EQ(refusal(first), cat("weir_known: struct_size is ", sizeof(First) - 1, ", and must be at least ",
                                sizeof(First), "; set it up with weir_known_init"));
  first.struct_size = kMaxStructBytes + 1;
  EXPECT_EQ(refusal(first), cat("weir_known: struct_size is 4097, and must be at least ", sizeof(First),
                                "; set it up with weir_known_init"));
  EXPECT_EQ(init_struct<Known>(nullptr, sizeof(Known)), WEIR_ERROR_USAGE);
  Known known{1, 2, 3, 4.0};
  EXPECT_EQ(init_struct(&known, sizeof(First) - 1), WEIR_ERROR_USAGE);
  EXPECT_EQ(init_struct(&known, kMaxStructBytes + 1), WEIR_ERROR_USAGE);
  EXPECT_EQ(known.a, 2);
}

}  // namespace
}  // namespace weir::c
