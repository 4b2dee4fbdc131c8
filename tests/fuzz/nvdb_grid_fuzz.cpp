// libFuzzer target for the reader of NanoVDB files. For any bytes, `open` must throw Error(input) or return a grid that
// can be walked, decoded and sampled in bounded time and without a read outside the bytes.
//
// The first byte of an input selects a grid type or none. With a type, the rest of the input damages a small valid file
// of this type field by field, because random bytes hardly ever get past the first offsets. With none, the rest is the
// file.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "format/base/error.h"
#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_grid.h"
#include "tests/fuzz/tiny_grid.h"

namespace weir {
namespace {

constexpr std::array<GridType, 5> kTypes{GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16,
                                         GridType::fpn};

const std::array<test::TinyGrid, kTypes.size()>& bases() {
  static const auto built = [] {
    std::array<test::TinyGrid, kTypes.size()> all;
    for (std::size_t i = 0; i < kTypes.size(); ++i) all[i] = test::TinyGridBuilder::build(kTypes[i]);
    return all;
  }();
  return built;
}

// Takes values from the bytes of the input. After their end it returns zeros.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }
  template <typename T>
  T take() {
    T value{};
    const std::size_t n = size_ < sizeof value ? size_ : sizeof value;
    std::memcpy(&value, data_, n);
    data_ += n;
    size_ -= n;
    return value;
  }
  std::vector<std::byte> rest() {
    std::vector<std::byte> bytes(size_);
    if (size_ != 0) std::memcpy(bytes.data(), data_, size_);
    data_ += size_;
    size_ = 0;
    return bytes;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

// Returns the offset of the part of the file that the selector `part` (0..9) stands for.
std::uint64_t part_offset(const test::TinyGrid& base, unsigned part) {
  const std::array<std::uint64_t, 10> parts{0,
                                            base.grid,
                                            base.grid + nvdb::kTreeOffset,
                                            base.grid + nvdb::kRootTilesOffset,
                                            base.upper,
                                            base.upper + nvdb::kUpper.child_mask,
                                            base.upper + nvdb::kUpper.table,
                                            base.lower + nvdb::kLower.table,
                                            base.leaf,
                                            base.blind};
  return parts[part % parts.size()];
}

void set_grid_bytes(std::vector<std::byte>& file, const test::TinyGrid& base) {
  if (file.size() < base.upper) return;
  const std::uint64_t bytes = file.size() - base.grid;
  for (const std::uint64_t field : {nvdb::meta::kGridSize, nvdb::meta::kFileSize, base.grid + nvdb::grid::kGridSize}) {
    std::memcpy(file.data() + field, &bytes, sizeof bytes);
  }
}

// Returns the base file after at most eight edits. An edit replaces a value of 1, 2, 4 or 8 bytes at an offset from a
// part, adds a small number to it, or changes the file's length with or without the lengths that its head records.
std::vector<std::byte> damaged(const test::TinyGrid& base, Input& input) {
  std::vector<std::byte> file = base.file;
  for (int edit = 0; edit < 8 && !input.empty(); ++edit) {
    const auto what = input.take<std::uint8_t>();
    const auto distance = input.take<std::uint16_t>();
    if (what >= 240) {
      const std::uint64_t size =
          what >= 248 ? file.size() - distance % (file.size() + 1) : file.size() + distance % 4096;
      file.resize(size);
      if (what % 2 == 0) set_grid_bytes(file, base);
      continue;
    }
    const std::uint64_t offset = part_offset(base, what % 10) + distance;
    const std::size_t bytes = std::size_t{1} << (what / 10 % 4);
    if (offset + bytes > file.size()) continue;
    std::uint64_t value = 0;
    std::memcpy(&value, file.data() + offset, bytes);
    value = what / 40 % 2 == 0 ? input.take<std::uint64_t>()
                               : value + static_cast<std::uint64_t>(std::int64_t{input.take<std::int8_t>()} * 32);
    std::memcpy(file.data() + offset, &value, bytes);
  }
  return file;
}

void require(bool holds) {
  if (!holds) std::abort();
}

// Runs `call`, which may throw Error(input) but no other error: open() does not read the leaves, so that a leaf may
// have an invalid bit width.
template <typename Call>
void may_throw_input(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::input);
  }
}

void use(const NvdbGrid& grid, Input& input) {
  if (grid.packed() != nullptr) return;  // packed_data_fuzz tests packed grids
  std::uint64_t blocks = 0;
  std::uint64_t leaves = 0;
  float sum = 0;
  std::array<float, kLeafVoxels> values{};
  grid.for_each_block([&](const GridBlock& block) {
    ++blocks;
    if (block.leaf == nullptr) return;
    ++leaves;
    for (unsigned n = 0; n < values.size(); ++n) sum += leaf_value(grid.type(), block.leaf, n);
    may_throw_input([&] { grid.decode_leaf(block.leaf, values); });
    sum += leaf_active(block.leaf, 511) ? 1.0F : 0.0F;
    require(block.leaf >= grid.data().data() && block.leaf < grid.data().data() + grid.data().size());
    may_throw_input([&] { sum += grid.value(block.origin + Index3{7, 7, 7}); });
  });
  const auto nodes = grid.node_counts();
  require(leaves == nodes[0]);
  require(blocks <= grid.root_tiles() + nvdb::kUpper.entries * std::uint64_t{nodes[2]} +
                        nvdb::kLower.entries * std::uint64_t{nodes[1]});
  require(grid.data_bytes() <= grid.grid_bytes() && grid.grid_offset() + grid.grid_bytes() <= grid.bytes().size());
  require(grid.index_bbox().voxels() < std::int64_t{1} << 62U);
  const MacrocellView cells = grid.macrocells();
  for (const MinMax& cell : cells.cells) sum += cell.min + cell.max;
  require(cells.cells.empty() || cells.cells.size() == static_cast<std::size_t>(cells.lattice.size()));
  sum += static_cast<float>(computed_head_checksum(grid));
  for (int i = 0; i < 16; ++i) {
    const Index3 at{input.take<std::int32_t>(), input.take<std::int32_t>(), input.take<std::int64_t>()};
    may_throw_input([&] { sum += grid.value(at); });
  }
  volatile float sink = sum;
  static_cast<void>(sink);
}

}  // namespace
}  // namespace weir

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weir::Input input(data, size);
  const std::size_t selector = input.take<std::uint8_t>() % (weir::kTypes.size() + 1);
  const std::vector<std::byte> file =
      selector < weir::kTypes.size() ? weir::damaged(weir::bases()[selector], input) : input.rest();
  try {
    weir::use(weir::NvdbGrid::open(file, "fuzz.nvdb"), input);
  } catch (const weir::Error& error) {
    weir::require(error.kind() == weir::ErrorKind::input);
  }
  return 0;
}
