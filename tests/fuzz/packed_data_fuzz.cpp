// libFuzzer target for packed data. For any bytes, `open` must throw Error(input) or return a grid. Its blocks can be
// looked up and decoded in bounded time and without a read outside the file.
//
// The first byte of an input selects what the rest does: it damages a small valid file field by field (header, region
// table, directory and streams), or it is the stream of the file's first block.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/nanovdb/read_box.h"
#include "tests/support/packed_grid.h"

namespace weir {
namespace {

constexpr std::size_t kMostBytes = 2500;  // the longest stream that an input may give to the block

void require(bool holds) {
  if (!holds) std::abort();
}

// Takes values from the bytes of the input. After their end it returns zeros.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  template <typename T>
  T take() {
    T value{};
    const std::size_t n = bytes_.size() < sizeof value ? bytes_.size() : sizeof value;
    if (n != 0) std::memcpy(&value, bytes_.data(), n);
    bytes_ = bytes_.subspan(n);
    return value;
  }
  test::PackedBytes rest(std::size_t most) {
    test::PackedBytes rest(bytes_.size() < most ? bytes_.size() : most);
    if (!rest.empty()) std::memcpy(rest.data(), bytes_.data(), rest.size());
    bytes_ = bytes_.subspan(rest.size());
    return rest;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

// Returns a file with two regions. The first block has the stream `stream`; the second region has no chunk.
test::PackedFile file_with(const test::PackedBytes& stream) {
  test::PackedGridOptions options;
  options.domain = {{0, 0, 0}, {130, 12, 20}};
  options.stream = [&](const Index3& block) {
    if (block == Index3{0, 0, 0}) return stream;
    return block.x % 3 == 1 && block.x < 16 ? test::constant_stream(static_cast<float>(block.x)) : test::PackedBytes{};
  };
  return test::PackedGridBuilder::build(options);
}

// Makes at most eight edits. An edit replaces a value of 1, 2, 4 or 8 bytes at an offset from a part, or adds a small
// number to it.
void damage(test::PackedFile& made, Input& input) {
  const std::array parts{
      made.packed,       made.packed + packed::kHeaderBytes,        made.table,
      made.chunks.at(0), made.chunks.at(0) + packed::chunk::kMasks, made.chunks.at(0) + packed::chunk::kGroups};
  for (int edit = 0; edit < 8 && !input.empty(); ++edit) {
    const auto what = input.take<std::uint8_t>();
    const std::uint64_t offset = parts[what % parts.size()] + input.take<std::uint16_t>() % 4096;
    const std::size_t bytes = std::size_t{1} << (what / 8 % 4);
    if (offset + bytes > made.file.size()) continue;
    std::uint64_t value = 0;
    std::memcpy(&value, made.file.data() + offset, bytes);
    value = what / 32 % 2 == 0 ? input.take<std::uint64_t>()
                               : value + static_cast<std::uint64_t>(std::int64_t{input.take<std::int8_t>()});
    std::memcpy(made.file.data() + offset, &value, bytes);
  }
}

template <typename Call>
void may_throw_input(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::input);
  }
}

void use(const NvdbGrid& grid) {
  require(grid.packed() != nullptr);
  std::array<float, kLeafVoxels> values{};
  float sum = 0;
  std::uint64_t blocks = 0;
  may_throw_input([&] {
    grid.for_each_block([&](const GridBlock& block) {
      ++blocks;
      may_throw_input([&] { grid.decode_block(block, values); });
      sum += values[511];
      if (block.stream.data == nullptr) return;
      require(block.stream.data >= grid.bytes().data());
      require(block.stream.data + block.stream.bytes <= grid.bytes().data() + grid.bytes().size());
    });
  });
  require(blocks <= 4096 * static_cast<std::uint64_t>(grid.packed()->regions().size()));
  for (const Index3& i : {Index3{0, 0, 0}, Index3{8, 8, 8}, Index3{129, 11, 19}, Index3{-1, 0, 0}}) {
    may_throw_input([&] { sum += grid.value(i); });
  }
  std::vector<float> box(std::size_t{9} * 9 * 9);
  may_throw_input([&] { read_box(grid, {{3, 3, 3}, {12, 12, 12}}, box); });
  volatile float sink = sum + box[0];
  static_cast<void>(sink);
}

}  // namespace
}  // namespace weir

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weir::Input input({data, size});
  const bool own_stream = input.take<std::uint8_t>() % 2 == 0;
  weir::test::PackedFile made =
      weir::file_with(own_stream ? input.rest(weir::kMostBytes) : weir::test::constant_stream(1));
  if (!own_stream) weir::damage(made, input);
  try {
    weir::use(weir::NvdbGrid::open(made.file, "fuzz.nvdb"));
  } catch (const weir::Error& error) {
    weir::require(error.kind() == weir::ErrorKind::input);
  }
  return 0;
}
