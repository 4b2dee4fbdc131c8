#include "ingest/streams/file_stream.h"

#include "tests/ingest/support/scratch.h"

namespace weir::file_stream_test {
namespace {

TEST(FileStream, SeeksAndReadsAcrossItsBuffer) {
  const Scratch scratch;
  std::vector<std::uint32_t> values(FileStreambuf::kBufferBytes);  // four buffers
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(i);
  InputFile file(scratch.write_values("a", values), DirectIo::off);
  FileStream stream(file);
  const auto read = [&] {
    std::uint32_t value = 0;
    stream.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  };
  EXPECT_EQ(read(), 0U);
  for (const std::size_t at : {std::size_t{5}, FileStreambuf::kBufferBytes / 4 - 1, FileStreambuf::kBufferBytes / 4,
                               values.size() - 1, std::size_t{3}, std::size_t{0}}) {
    stream.seekg(static_cast<std::streamoff>(4 * at));
    EXPECT_EQ(stream.tellg(), std::streampos(static_cast<std::streamoff>(4 * at)));
    EXPECT_EQ(read(), at);
  }
  stream.seekg(-4, std::ios::end);
  EXPECT_EQ(read(), values.size() - 1);
  stream.seekg(0);
  std::vector<std::uint32_t> all(values.size());
  stream.read(reinterpret_cast<char*>(all.data()), static_cast<std::streamsize>(4 * all.size()));
  EXPECT_EQ(all, values);
}

TEST(FileStream, ThrowsAtItsEnd) {
  const Scratch scratch;
  InputFile file(scratch.write_values("a", std::vector<char>{1, 2, 3}), DirectIo::off);
  FileStream stream(file);
  std::array<char, 4> bytes{};
  EXPECT_THROW(stream.read(bytes.data(), 4), std::ios_base::failure);
}

}  // namespace
}  // namespace weir::file_stream_test
