#include "compressor/file_digest.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/temporary_directory.h"

namespace weir::file_digest_test {
namespace {

std::vector<std::byte> pattern(std::size_t bytes) {
  std::vector<std::byte> data(bytes);
  for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::byte>(i * 2654435761U >> 13U);
  return data;
}

class FileDigest : public testing::Test {
 protected:
  std::unique_ptr<File> file_of(std::span<const std::byte> data) {
    auto file = files_->create(directory_ / "volume");
    file->write_at(0, data);
    return file;
  }

  TemporaryDirectory directory_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

TEST_F(FileDigest, CombinesPiecesOf16MiB) {
  const auto data = pattern(2 * kDigestPieceBytes + 17);
  const std::span<const std::byte> all(data);
  const std::vector<Digest> pieces{piece_digest(all.first(kDigestPieceBytes)),
                                   piece_digest(all.subspan(kDigestPieceBytes, kDigestPieceBytes)),
                                   piece_digest(all.last(17))};
  EXPECT_EQ(digest_of_file(*file_of(all), no_team()), combine(pieces));
  EXPECT_EQ(digest_of_file(*file_of(all.first(kDigestPieceBytes)), no_team()), combine(std::span(pieces).first(1)));
  EXPECT_EQ(digest_of_file(*file_of({}), no_team()), combine({}));
}

TEST_F(FileDigest, SaysHowFarItIsAndEndsByWhatThatThrows) {
  const auto data = pattern(kDigestPieceBytes + 5);
  const auto file = file_of(data);
  std::vector<std::uint64_t> done;
  digest_of_file(*file, no_team(), [&](std::uint64_t bytes) { done.push_back(bytes); });
  EXPECT_EQ(done, std::vector<std::uint64_t>{data.size()});
  struct Stop {};
  EXPECT_THROW(digest_of_file(*file, no_team(), [](std::uint64_t) { throw Stop(); }), Stop);
}

TEST_F(FileDigest, MappingHasTheDigestOfItsFile) {
  const auto data = pattern(kDigestPieceBytes + 5);
  std::vector<std::uint64_t> done;
  const Digest digest = digest_of_mapping(data, nullptr, [&](std::uint64_t bytes) { done.push_back(bytes); });
  EXPECT_EQ(digest, digest_of_file(*file_of(data), no_team()));
  EXPECT_EQ(done, std::vector<std::uint64_t>{data.size()});
  EXPECT_EQ(digest_of_mapping({}, nullptr), combine({}));
}

}  // namespace
}  // namespace weir::file_digest_test
