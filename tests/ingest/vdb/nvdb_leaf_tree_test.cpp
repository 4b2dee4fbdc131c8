#include "ingest/vdb/nvdb_leaf_tree.h"

#include <filesystem>
#include <fstream>

#include "format/base/error.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/stock/stock_nvdb.h"

namespace weir::nvdb_tree_test {
namespace {

namespace fs = std::filesystem;
using test::StockNvdb;

TEST(NvdbNodes, MoreThanTheLimit_AreReadAnewWithTheSameBytes) {
  const Scratch scratch;
  constexpr std::size_t kNode = std::size_t{1} << 20U;
  constexpr std::size_t kNodes = (NvdbNodes::kLimit >> 20U) + 4;
  std::vector<std::byte> bytes(kNodes * kNode);
  for (std::size_t i = 0; i < kNodes; ++i) bytes[i * kNode] = static_cast<std::byte>(i);
  InputFile file(scratch.write("a", bytes), DirectIo::off);
  NvdbNodes nodes(file, 0, bytes.size());
  for (std::size_t i = 0; i < kNodes; ++i)
    EXPECT_EQ(nodes.read(i * kNode, kNode, 0)->front(), static_cast<std::byte>(i));
  const std::uint64_t once = file.bytes_read();
  EXPECT_EQ(once, bytes.size());
  EXPECT_EQ(nodes.read((kNodes - 1) * kNode, kNode, 0)->front(), static_cast<std::byte>(kNodes - 1));
  EXPECT_EQ(file.bytes_read(), once) << "the last one is kept";
  EXPECT_EQ(nodes.read(0, kNode, 0)->front(), std::byte{0});
  EXPECT_EQ(file.bytes_read(), once + kNode) << "the first one is not";
}

TEST(NvdbNodes, OutsideOfTheGrid_IsAnError) {
  const Scratch scratch;
  const std::string path = scratch.write("a", std::vector<std::byte>(100));
  InputFile file(path, DirectIo::off);
  NvdbNodes nodes(file, 10, 90);
  const std::string end = ", and the grid lies in bytes 10 to 90; it is damaged or was rewritten while it was read";
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { nodes.read(9, 10, 7); }),
            path + ": at byte 7: a node points to byte 9" + end);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { nodes.read(81, 10, 7); }),
            path + ": at byte 7: a node points to byte 81" + end);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { nodes.read(~std::uint64_t{0} - 3, 10, 7); }),
            path + ": at byte 7: a node points to byte 18446744073709551612" + end);
  EXPECT_EQ(nodes.read(80, 10, 7)->size(), 10U);
}

// Reads the boxes in which the stock file has leaves. Returns the message of the first error; empty if there is none.
std::string read_until_error(VolumeSource& source) {
  try {
    for (const Box& wanted : test::stock_sample_boxes()) {
      const Box box = intersect(wanted, source.info().domain());
      std::vector<float> values(static_cast<std::size_t>(box.voxels()));
      source.read(box, values);
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return {};
}

TEST(NvdbTree, FileCutWhileItIsRead_IsAnErrorAndNoSignal) {
  const Scratch scratch;
  for (const GridType type : {GridType::float32, GridType::fpn}) {
    const std::string path = scratch.write("a.nvdb", StockNvdb(type).file());
    const auto source = open_source(path, {});
    const std::uintmax_t bytes = fs::file_size(path);
    fs::resize_file(path, 5000);
    const std::string message = read_until_error(*source);
    EXPECT_TRUE(message.starts_with(path + ": the file ended at offset ")) << message;
    EXPECT_TRUE(message.ends_with("; it had " + std::to_string(bytes) +
                                  " bytes when it was opened: it was cut while being read"))
        << message;
  }
}

TEST(NvdbTree, FileRewrittenWithNoiseWhileItIsRead_IsAnErrorAndNoSignal) {
  const Scratch scratch;
  for (const GridType type : {GridType::float32, GridType::fp8, GridType::fpn}) {
    const std::string path = scratch.write("a.nvdb", StockNvdb(type).file());
    const auto source = open_source(path, {});
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file << std::string(fs::file_size(path), '\x7F');
    file.close();
    const std::string message = read_until_error(*source);
    EXPECT_NE(message.find(": a node points to byte "), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace weir::nvdb_tree_test
