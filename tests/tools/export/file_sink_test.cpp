#include "tools/export/file_sink.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <span>

#include "format/base/error.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/run_command.h"

namespace weir::file_sink_test {
namespace {

TEST(FileSink, WritesInOrderFromItsOffset) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  const auto file = files->create(directory / "a");
  std::string expected(FileSinkbuf::kBufferBytes + 1000, '\0');
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<char>(i * 7 % 251);
  FileSink sink(*file, 5);
  sink.put(expected[0]);
  sink.write(expected.data() + 1, 99);
  EXPECT_EQ(sink.position(), 105U);
  sink.write(expected.data() + 100, static_cast<std::streamsize>(expected.size() - 100));
  EXPECT_EQ(sink.position(), 5 + expected.size());
  const Digest digest = sink.finish();
  EXPECT_EQ(read_file(directory / "a"), std::string(5, '\0') + expected);

  const auto bytes = std::as_bytes(std::span(expected));
  DigestStream pieces;
  pieces.update(piece_digest(bytes.first(FileSinkbuf::kBufferBytes)));
  pieces.update(piece_digest(bytes.subspan(FileSinkbuf::kBufferBytes)));
  EXPECT_EQ(digest, pieces.digest());
}

TEST(FileSink, ThrowsWhatTheFileThrows) {
  const TemporaryDirectory directory;
  const auto real = make_posix_file_system();
  FaultyFileSystem full(*real, 1, ENOSPC);
  const auto file = full.create(directory / "a");
  FileSink sink(*file, 0);
  const std::string bytes(FileSinkbuf::kBufferBytes, 'x');
  try {
    sink.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
  }
}

}  // namespace
}  // namespace weir::file_sink_test
