// Tests unpack_lzf() with good and damaged streams.
#include "ingest/hdf5/filters/undo_filters.h"

#include <string>
#include <string_view>

#include "tests/ingest/support/scratch.h"

namespace weir::filter_lzf_test {
namespace {

std::string unpacked(std::string_view stream, std::size_t bytes) {
  std::string text(bytes, '?');
  unpack_lzf(std::as_bytes(std::span(stream)), std::as_writable_bytes(std::span(text)));
  return text;
}

TEST(FilterLzf, LiteralsAndRepeats) {
  EXPECT_EQ(unpacked("", 0), "");
  EXPECT_EQ(unpacked({"\x02xyz", 4}, 3), "xyz");
  EXPECT_EQ(unpacked({"\x02xyz\x20\x02", 6}, 6), "xyzxyz");
  // A repeat of the greatest length, 264 bytes, that overlaps its own output.
  EXPECT_EQ(unpacked({"\x00"
                      "a\xE0\xFF\x00",
                      5},
                     1 + 264),
            std::string(265, 'a'));
  // A repeat from the greatest distance, 8192 bytes back.
  std::string far;
  std::string plain;
  for (int i = 0; i < 256; ++i) {
    const std::string run(32, static_cast<char>(i));
    far += '\x1F' + run;
    plain += run;
  }
  EXPECT_EQ(unpacked(far + std::string("\x3F\xFF", 2), 8195), plain + std::string(3, '\0'));
}

TEST(FilterLzf, DamageIsAnError) {
  const auto message = [](std::string_view stream, std::size_t bytes) {
    return message_of_error(ErrorKind::input, [&] { unpacked(stream, bytes); });
  };
  EXPECT_EQ(message({"\x02xy", 3}, 3), "its lzf stream is cut after 0 of 3 bytes");
  EXPECT_EQ(message({"\x00x\x20", 3}, 4), "its lzf stream is cut after 1 of 4 bytes");
  EXPECT_EQ(message({"\x00x\xE0", 3}, 400), "its lzf stream is cut after 1 of 400 bytes");
  EXPECT_EQ(message({"\x02xyz", 4}, 2), "its lzf stream holds more after 0 of 2 bytes");
  EXPECT_EQ(message({"\x00x\x20\x00", 4}, 3), "its lzf stream holds more after 1 of 3 bytes");
  EXPECT_EQ(message({"\x02xyz", 4}, 5), "its lzf stream ends after 3 of 5 bytes");
  EXPECT_EQ(message({"\x00x\x20\x01", 4}, 4), "its lzf stream repeats what is not there after 1 of 4 bytes");
  EXPECT_EQ(message("", 1), "its lzf stream ends after 0 of 1 bytes");
}

}  // namespace
}  // namespace weir::filter_lzf_test
