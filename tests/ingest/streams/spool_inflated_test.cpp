#include "ingest/streams/spool_inflated.h"

#include "tests/ingest/support/packed.h"
#include "tests/ingest/support/scratch.h"

namespace weir::spool_inflated_test {
namespace {

/// Returns noise. Because it hardly compresses, it can span several of the reader's pieces even when it is packed.
std::vector<std::byte> noise(std::size_t bytes) {
  std::vector<std::byte> values(bytes);
  std::uint32_t state = 1;
  for (std::byte& value : values) {
    state = state * 1664525U + 1013904223U;  // Numerical Recipes
    value = static_cast<std::byte>(state >> 24U);
  }
  return values;
}

class SpoolInflated : public ::testing::Test {
 protected:
  /// Writes a file of `head` bytes and then `content`, packed. Returns its path.
  std::string pack(std::span<const std::byte> content, std::size_t head) {
    std::vector<std::byte> bytes(head, std::byte{'h'});
    const auto packed = deflated(content, Wrapper::gzip);
    packed_ = {head, packed.size()};
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    return scratch_.write("data.bin", bytes);
  }
  std::unique_ptr<InputFile> spool(const std::string& path, const UnpackedRange& wanted) {
    InputFile file(path, DirectIo::automatic);
    return spool_inflated(file, packed_, wanted, {});
  }

  Scratch scratch_;
  PackedRange packed_;
};

TEST_F(SpoolInflated, KeepsOnlyTheRequestedRange) {
  const auto content = noise(std::size_t{5} << 19U);
  const std::string path = pack(content, 13);
  const std::vector<UnpackedRange> ranges{{0, content.size(), content.size()},
                                          {1, 5, content.size()},
                                          {300000, 1000000, content.size()},
                                          {content.size() - 3, 3, content.size()}};
  for (const UnpackedRange& wanted : ranges) {
    const auto file = spool(path, wanted);
    ASSERT_EQ(file->size(), wanted.bytes);
    std::vector<std::byte> read(wanted.bytes);
    file->read_buffered(0, read, ReadPath::through);
    EXPECT_TRUE(std::equal(read.begin(), read.end(), content.begin() + static_cast<std::ptrdiff_t>(wanted.offset)));
  }
}

TEST_F(SpoolInflated, TheStreamMustBeAsLongAsItsHeaderSays) {
  const std::string path = pack(noise(100), 0);
  EXPECT_EQ(message_of_error(ErrorKind::input,
                             [&] {
                               spool(path, {0, 99, 99});
                             }),
            path + ": unpacks to more than the 99 bytes its header asks for; one of the two is damaged");
  EXPECT_EQ(message_of_error(ErrorKind::input,
                             [&] {
                               spool(path, {0, 100, 101});
                             }),
            path + ": unpacks to 100 bytes, and its header asks for 101; one of the two is damaged");
}

TEST_F(SpoolInflated, SizeBeyondWhatTheStreamCanHoldIsRefused) {
  const std::string path = pack(noise(100), 0);
  const std::uint64_t much = std::uint64_t{1} << 60U;
  EXPECT_EQ(message_of_error(ErrorKind::input,
                             [&] {
                               spool(path, {0, much, much});
                             }),
            path + ": " + std::to_string(packed_.bytes) +
                " compressed bytes cannot hold the 1152921504606846976 bytes its header asks for; one of the two is "
                "damaged");
}

TEST_F(SpoolInflated, Cancelled_EndsBeforeTheStreamDoes) {
  const std::string path = pack(noise(100), 0);
  const std::atomic<bool> cancel{true};
  SourceOptions options;
  options.cancel = &cancel;
  InputFile file(path, DirectIo::automatic);
  // Skipping bytes takes as long as keeping them, so both can be cancelled.
  for (const UnpackedRange& wanted : {UnpackedRange{0, 100, 100}, UnpackedRange{100, 0, 100}}) {
    EXPECT_EQ(message_of_error(ErrorKind::interrupted, [&] { spool_inflated(file, packed_, wanted, options); }),
              "interrupted");
  }
}

}  // namespace
}  // namespace weir::spool_inflated_test
