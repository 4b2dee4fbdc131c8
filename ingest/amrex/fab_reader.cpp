#include "ingest/amrex/fab_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "format/base/scalar_type.h"
#include "ingest/plan/box_pieces.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

constexpr std::size_t kRowValues = 1024;  // values decoded at a time if a cell's value is repeated along x
constexpr std::size_t kWidestReal = 8;    // bytes of the widest value

/// The cells of one FAB's component as they lie in its file.
struct StoredCells {
  Index3 extent;             ///< of the FAB
  std::uint64_t offset = 0;  ///< of the component's first value in the file
  std::uint64_t bytes = 8;   ///< of a value

  std::uint64_t at(const Index3& cell) const { return static_cast<std::uint64_t>(linear_index(cell, extent)) * bytes; }
  /// Returns the bytes from the first byte of a box of cells to its last.
  std::uint64_t span_of(const Box& box) const { return at(box.hi - Index3{1, 1, 1}) + bytes - at(box.lo); }
};

/// Returns the cells of `part` from `lo` on that are read at once. The bytes between its rows and planes are read
/// too, if they are at most as many as the wanted ones, or if the gap is small (kMaxGapBytes).
Box next_piece(const StoredCells& stored, const Box& part, const Index3& lo) {
  const auto fits = [&](const Box& box) { return stored.span_of(box) <= kPieceBytes; };
  const auto joins = [&](std::int64_t wanted, std::int64_t all, std::uint64_t step) {
    return 2 * wanted >= all || static_cast<std::uint64_t>(all - wanted) * step <= kMaxGapBytes;
  };
  Box piece{lo, lo + Index3{1, 1, 1}};
  piece.hi.x = std::min(part.hi.x, lo.x + static_cast<std::int64_t>(kPieceBytes / stored.bytes));
  if (lo.x != part.lo.x || piece.hi.x != part.hi.x) return piece;
  const std::uint64_t row = static_cast<std::uint64_t>(stored.extent.x) * stored.bytes;
  if (!joins(part.extent().x, stored.extent.x, stored.bytes)) return piece;
  piece.hi.y = part.hi.y;
  if (!fits(piece)) piece.hi.y = lo.y + std::max<std::int64_t>(1, static_cast<std::int64_t>(kPieceBytes / row));
  piece.hi.y = std::min(piece.hi.y, part.hi.y);
  while (piece.hi.y > lo.y + 1 && !fits(piece)) --piece.hi.y;
  if (lo.y != part.lo.y || piece.hi.y != part.hi.y) return piece;
  if (!joins(part.extent().y, stored.extent.y, row)) return piece;
  const std::uint64_t plane = row * static_cast<std::uint64_t>(stored.extent.y);
  piece.hi.z = std::min(part.hi.z, lo.z + std::max<std::int64_t>(1, static_cast<std::int64_t>(kPieceBytes / plane)));
  while (piece.hi.z > lo.z + 1 && !fits(piece)) --piece.hi.z;
  return piece;
}

/// Calls take(piece) for the pieces that fill `part`, one after the other.
template <typename Take>
void for_each_piece(const StoredCells& stored, const Box& part, const Take& take) {
  Index3 lo = part.lo;
  while (lo.z < part.hi.z) {
    const Box piece = next_piece(stored, part, lo);
    take(piece);
    lo.x = piece.hi.x;
    if (lo.x < part.hi.x) continue;
    lo.x = part.lo.x;
    lo.y = piece.hi.y;
    if (lo.y < part.hi.y) continue;
    lo.y = part.lo.y;
    lo.z = piece.hi.z;
  }
}

/// Writes the values of stored cells to the values of a box of the wanted level.
struct Painter {
  Index3 by;  ///< cells of the wanted level along a stored cell
  RealLayout layout;
  const ValueMapping& mapping;
  Box box;  ///< of the wanted level
  std::span<float> values;

  std::span<float> row(const Index3& lo, std::int64_t count) const {
    return values.subspan(static_cast<std::size_t>(linear_index(lo - box.lo, box.extent())),
                          static_cast<std::size_t>(count));
  }

  /// Decodes a row of stored cells into `out` and repeats each value along x. `first` points at the value of the
  /// stored cell `lo`; out[0] is the cell `x` of the wanted level.
  ConversionLoss decode_row(const std::byte* first, std::int64_t lo, std::int64_t x, std::span<float> out) const {
    const std::size_t bytes = scalar_bytes(layout.type);
    if (by.x == 1) {
      const std::byte* const from = first + static_cast<std::size_t>(x - lo) * bytes;
      return decode_values({from, out.size() * bytes}, layout.type, layout.big_endian, mapping, out);
    }
    std::array<std::byte, kRowValues * kWidestReal> repeated;
    ConversionLoss loss;
    for (std::size_t done = 0; done < out.size(); done += kRowValues) {
      const std::size_t count = std::min(kRowValues, out.size() - done);
      for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t cell = (x + static_cast<std::int64_t>(done + i)) / by.x;
        std::memcpy(repeated.data() + i * bytes, first + static_cast<std::size_t>(cell - lo) * bytes, bytes);
      }
      loss.add(decode_values({repeated.data(), count * bytes}, layout.type, layout.big_endian, mapping,
                             out.subspan(done, count)));
    }
    return loss;
  }

  /// Writes all cells of `part` (of the wanted level) that lie in the row (y, z) of stored cells. `first` points at
  /// the value of the row's cell `lo`.
  ConversionLoss paint_row(const std::byte* first, std::int64_t lo, std::int64_t y, std::int64_t z,
                           const Box& part) const {
    const std::int64_t y0 = std::max(part.lo.y, y * by.y);
    const std::int64_t y1 = std::min(part.hi.y, (y + 1) * by.y);
    const std::int64_t z0 = std::max(part.lo.z, z * by.z);
    const std::int64_t z1 = std::min(part.hi.z, (z + 1) * by.z);
    const std::int64_t count = part.extent().x;
    const std::span<float> decoded = row({part.lo.x, y0, z0}, count);
    const ConversionLoss loss = decode_row(first, lo, part.lo.x, decoded);
    for (std::int64_t at_z = z0; at_z < z1; ++at_z) {
      for (std::int64_t at_y = y0; at_y < y1; ++at_y) {
        if (at_y == y0 && at_z == z0) continue;
        std::copy(decoded.begin(), decoded.end(), row({part.lo.x, at_y, at_z}, count).begin());
      }
    }
    return loss.times(static_cast<std::uint64_t>((y1 - y0) * (z1 - z0)));
  }
};

}  // namespace

FabReader::FabReader(const Plotfile& plotfile, std::size_t component, DirectIo mode, Notice notice)
    : plotfile_(plotfile),
      component_(component),
      files_(plotfile, mode),
      check_(plotfile, component, std::move(notice)) {}

ConversionLoss FabReader::read(std::size_t wanted, std::span<const CoverPart> parts, const Box& box,
                               const ValueMapping& mapping, std::span<float> values) {
  const std::size_t number = parts.front().level;
  const std::uint32_t fab = parts.front().fab;
  const PlotfileLevel& level = plotfile_.levels[number];
  const Index3 by = refinement(plotfile_.levels, number, wanted);
  const Box cells = level.boxes[fab].box();

  Box needed = coarsened(parts.front().box, by);
  for (const CoverPart& part : parts) {
    const Box of_part = coarsened(part.box, by);
    needed = {min(needed.lo, of_part.lo), max(needed.hi, of_part.hi)};
  }
  const std::shared_ptr<InputFile> file = files_.file_of(number, fab);
  StoredCells stored;
  stored.extent = cells.extent();
  stored.bytes = scalar_bytes(plotfile_.layout.type);
  stored.offset = files_.values_offset(number, fab, *file) +
                  component_ * static_cast<std::uint64_t>(volume(stored.extent)) * stored.bytes;
  const Painter painter{by, plotfile_.layout, mapping, box, values};
  const StagingPool::Lease staging(staging_);
  ConversionLoss loss;
  for_each_piece(stored, {needed.lo - cells.lo, needed.hi - cells.lo}, [&](const Box& piece) {
    const Box here{piece.lo + cells.lo, piece.hi + cells.lo};
    const auto touches = [&](const CoverPart& part) { return !intersect(refined(here, by), part.box).empty(); };
    if (std::none_of(parts.begin(), parts.end(), touches)) return;
    const std::uint64_t offset = stored.offset + stored.at(piece.lo);
    const std::uint64_t count = stored.span_of(piece);
    std::span<const std::byte> bytes;
    if (const ReadPath path = file->path_for(offset, count); path == ReadPath::direct) {
      bytes = file->read_direct(offset, count, staging.bytes());
    } else {
      file->read_buffered(offset, staging.bytes().first(count), path);
      bytes = staging.bytes().first(count);
    }
    for (const CoverPart& part : parts) {
      const Box shown = intersect(refined(here, by), part.box);
      if (shown.empty()) continue;
      const Box coarse = coarsened(shown, by);
      for (std::int64_t z = coarse.lo.z; z < coarse.hi.z; ++z) {
        for (std::int64_t y = coarse.lo.y; y < coarse.hi.y; ++y) {
          const std::uint64_t at = stored.at(Index3{here.lo.x, y, z} - cells.lo) - stored.at(piece.lo);
          const std::span<const std::byte> row =
              bytes.subspan(at + static_cast<std::uint64_t>(coarse.lo.x - here.lo.x) * stored.bytes,
                            static_cast<std::uint64_t>(coarse.extent().x) * stored.bytes);
          check_.look_at(number, fab, file->path(), row);
          loss.add(painter.paint_row(bytes.data() + at, here.lo.x, y, z, shown));
        }
      }
    }
  });
  return loss;
}

}  // namespace weir
