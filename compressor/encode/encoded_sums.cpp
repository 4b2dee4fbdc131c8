#include "compressor/encode/encoded_sums.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <vector>

#include "compressor/encode/stream_pieces.h"
#include "format/io/digest.h"

namespace weir {
namespace {

// Sums the checksums of pieces of a file. Reads adjacent pieces together.
class PieceReader {
 public:
  explicit PieceReader(File& file) : file_(file) {}

  void add(std::uint64_t offset, std::size_t bytes) {
    if (!pieces_.empty() && (offset != end() || end() - pieces_.front().offset >= kMostBytes)) finish();
    pieces_.push_back({offset, bytes});
  }
  /// Reads the pieces that are held and adds their checksums to the sum.
  void finish() {
    if (pieces_.empty()) return;
    const std::uint64_t begin = pieces_.front().offset;
    bytes_.resize(end() - begin);
    file_.read_at(begin, bytes_);
    for (const Piece& piece : pieces_) {
      sum_ += placed_checksum(piece.offset, std::span(bytes_).subspan(piece.offset - begin, piece.bytes));
    }
    pieces_.clear();
  }
  std::uint64_t sum() const { return sum_; }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 18U;
  struct Piece {
    std::uint64_t offset;
    std::size_t bytes;
  };
  std::uint64_t end() const { return pieces_.back().offset + pieces_.back().bytes; }

  File& file_;
  std::vector<Piece> pieces_;
  std::vector<std::byte> bytes_;
  std::uint64_t sum_ = 0;
};

// The sums of one thread.
class WrittenSums {
 public:
  explicit WrittenSums(const EncodeTarget& target) : target_(target), volume_(target.out) {}

  // Adds the leaves of a region in `box`.
  void add(std::int64_t region, const Box& box) {
    const RegionPlaces places = places_of(target_, region);
    for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
      places.streams ? add_streams(region, box, x, *places.streams) : add_leaves(region, box, x, *places.leaves);
      volume_.finish();
      add_records();
    }
  }
  EncodedSums sums() const { return {volume_.sum(), records_}; }

 private:
  void add_streams(std::int64_t region, const Box& box, std::int64_t x, const StreamPlaces& places) {
    for_each_kept_stream(
        target_, region, places, box, x,
        [&](std::uint64_t offset, std::span<const std::byte> ends) { volume_.add(offset, ends.size()); },
        [&](const Index3& leaf, const KeptPlace& place) {
          volume_.add(place.offset, places.bytes(place.position));
          ordinals_.push_back(place.ordinal);
          if (!target_.packed->rule.preview || !is_corner(target_.tree.leaves, leaf)) return;
          volume_.add(corner_offset(target_.layout, leaf), nvdb::kFloatLeafBytes);
        });
  }

  void add_leaves(std::int64_t region_index, const Box& box, std::int64_t x, const LeafPlaces& places) {
    const Region& region = target_.tree.regions[static_cast<std::size_t>(region_index)];
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        const std::size_t position = target_.tree.mask_position({x, y, z});
        if (!places.kept(position)) continue;
        const LeafPlaces::Place before = places.before(position);
        volume_.add(target_.layout.leaves + region.first_byte + before.bytes, leaf_bytes(places.width(position)));
        ordinals_.push_back(region.first_leaf + before.leaves);
      }
    }
  }

  void add_records() {
    if (ordinals_.empty()) return;
    const auto count = static_cast<std::uint32_t>(ordinals_.back() - ordinals_.front() + 1);  // records of one layer
    const std::vector<LeafRecord> records = target_.records->read(ordinals_.front(), count);
    for (const std::uint64_t ordinal : ordinals_) {
      records_ += record_checksum(ordinal, records[static_cast<std::size_t>(ordinal - ordinals_.front())]);
    }
    ordinals_.clear();
  }

  const EncodeTarget& target_;
  PieceReader volume_;
  std::vector<std::uint64_t> ordinals_;  // ordinals of a layer's records, ascending
  std::uint64_t records_ = 0;
};

}  // namespace

EncodedSums sums_of_written(const EncodeTarget& target, const BoxSet& done) {
  tbb::enumerable_thread_specific<WrittenSums> found([&] { return WrittenSums(target); });
  tbb::parallel_for(std::size_t{0}, target.tree.regions.size(), [&](std::size_t i) {
    if (target.tree.regions[i].leaves == 0) return;
    const auto region = static_cast<std::int64_t>(i);
    for (const Box& box : done.boxes()) {
      const Box part = intersect(target.tree.leaf_box(region), box);
      if (!part.empty()) found.local().add(region, part);
    }
  });
  EncodedSums sums;
  for (const WrittenSums& some : found) sums.add(some.sums());
  return sums;
}

bool has_empty_padding(const EncodeTarget& target) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20U;
  std::vector<std::byte> bytes;
  const std::uint64_t end = std::min(target.layout.file_bytes, target.out.size());
  for (std::uint64_t at = target.layout.content_end; at < end; at += kPiece) {
    bytes.resize(std::min(kPiece, end - at));
    target.out.read_at(at, bytes);
    if (std::any_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte != std::byte{0}; })) return false;
  }
  return true;
}

}  // namespace weir
