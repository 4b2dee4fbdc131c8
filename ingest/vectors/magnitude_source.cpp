#include "ingest/vectors/magnitude_source.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "ingest/headers/header_text.h"
#include "ingest/values/value_notes.h"
#include "ingest/values/vector_lengths.h"

namespace weir {
namespace {

constexpr std::int64_t kPieceVoxels = 65536;
/// A chunk with more voxels than this is read in pieces, and so is read several times.
constexpr std::int64_t kLargestChunk = std::int64_t{1} << 22;
/// The bytes of a piece for each voxel: a sum of squares, a component, and a flag for missing values.
constexpr std::uint64_t kMagnitudeVoxelBytes = sizeof(double) + sizeof(float) + 1;

std::string named(const SourceInfo& info) { return in_quotes(info.dataset); }

std::string placed(const SourceInfo& info) {
  const auto& [x, y, z] = info.spacing;
  return cat(info.extent.x, " x ", info.extent.y, " x ", info.extent.z, " voxels of ", x, ", ", y, ", ", z, " at ",
             info.origin[0], ", ", info.origin[1], ", ", info.origin[2]);
}

void check_same_voxels(const SourceInfo& a, const SourceInfo& b) {
  if (a.domain() == b.domain() && a.spacing == b.spacing && a.origin == b.origin) return;
  throw Error(ErrorKind::input,
              cat(a.path, ": ", named(a), " has ", placed(a), " and ", named(b), " ", placed(b),
                  ", not the same ones; take the components to the same grid, or convert them one by one"));
}

// Throws if the components have different irregular coordinates or different times.
void check_same_places(const SourceInfo& a, const SourceInfo& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.details.axes.at(i).coordinates == b.details.axes.at(i).coordinates) continue;
    throw Error(ErrorKind::input, cat(a.path, ": ", named(a), " and ", named(b), " have other coordinates along ",
                                      "xyz"[i], "; take the components to the same grid, or convert them one by one"));
  }
  if (!a.details.time || !b.details.time || a.details.time->value == b.details.time->value) return;
  throw Error(ErrorKind::input, compose(a.path, ": ", named(a), " is of time ", a.details.time->value, " and ",
                                        named(b), " of ", b.details.time->value, "; choose the same time with ",
                                        option("index"), ", or convert them one by one"));
}

void check_same_units(const SourceInfo& a, const SourceInfo& b) {
  const bool named_apart = !a.units.empty() && !b.units.empty() && a.units != b.units;
  if (a.unit_si.value_or(1) == b.unit_si.value_or(1) && !named_apart) return;
  const auto unit = [](const SourceInfo& info) {
    return cat(info.units.empty() ? "units" : info.units, info.unit_si ? cat(" of unitSI ", *info.unit_si) : "");
  };
  throw Error(ErrorKind::input, cat(a.path, ": ", named(a), " is in ", unit(a), " and ", named(b), " in ", unit(b),
                                    ", so that no length is made of them; convert them one by one"));
}

// Adds the files that the components lie in, each once.
void add_files(const SourceInfo& other, SourceInfo& info) {
  for (const FileState& file : other.files) {
    const auto same = [&](const FileState& known) { return known.path == file.path; };
    if (std::ranges::none_of(info.files, same)) info.files.push_back(file);
  }
  info.mtime_ns = std::max(info.mtime_ns, other.mtime_ns);
}

// "/v: 1 of its 2 chunks was never written ...", of each component that lacks some.
std::string lacking_chunks(const std::vector<std::unique_ptr<VolumeSource>>& components) {
  std::string all;
  for (const auto& component : components) {
    const SourceInfo& info = component->info();
    const std::string& note = info.details.chunks_note;
    add_note(note.empty() ? "" : cat(info.dataset, ": ", note), all);
  }
  return all;
}

bool same_chunks(const AccessShape& a, const AccessShape& b) {
  return a.chunk == b.chunk && a.chunk_origin == b.chunk_origin;
}

/// Sums of squares of the voxels of a piece, and their roots.
class Piece {
 public:
  explicit Piece(std::size_t voxels) : sums_(voxels), component_(voxels), missing_(std::make_unique<bool[]>(voxels)) {}

  std::span<float> component() { return component_; }
  /// Adds the squares of the values in component(). If `marks_missing` is set, missing_value() marks a voxel without
  /// a value.
  void add(bool marks_missing) {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      sums_[i] += squared_part(static_cast<double>(component_[i]));
      missing_[i] = missing_[i] || (marks_missing && is_missing(component_[i]));
    }
  }
  /// Writes the lengths into component().
  ConversionLoss take_lengths() {
    return weir::take_lengths(sums_, std::span<const bool>(missing_.get(), sums_.size()), component_);
  }

 private:
  std::vector<double> sums_;
  std::vector<float> component_;
  std::unique_ptr<bool[]> missing_;
};

/// The losses of the lengths, from the losses of their components. They are bounds, because the affected voxels are
/// unknown.
class LengthLoss {
 public:
  explicit LengthLoss(std::uint64_t voxels) : voxels_(voxels) {}

  void add_component(const ConversionLoss& loss) {
    counts_.add(loss);
    squares_ += loss.max_abs_error * loss.max_abs_error;  // a length changes by no more than the vector
  }
  void add_root(const ConversionLoss& loss) {
    counts_.add(loss);
    of_root_ = std::max(of_root_, loss.max_abs_error);
  }
  /// Each voxel counts once.
  ConversionLoss of_lengths() const {
    const auto at_most = [&](std::uint64_t count) { return std::min(count, voxels_); };
    return {at_most(counts_.inexact), at_most(counts_.overflow), std::sqrt(squares_) + of_root_,
            at_most(counts_.unmarked)};
  }

 private:
  std::uint64_t voxels_;
  ConversionLoss counts_;
  double squares_ = 0;
  double of_root_ = 0;
};

class MagnitudeSource final : public VolumeSource {
 public:
  MagnitudeSource(std::vector<std::unique_ptr<VolumeSource>> components, SourceInfo info)
      : components_(std::move(components)), info_(std::move(info)), access_(components_.front()->access()) {
    access_.bytes_per_voxel = 0;
    for (const auto& component : components_) {
      const AccessShape shape = component->access();
      access_.bytes_per_voxel += shape.bytes_per_voxel;
      if (!same_chunks(shape, access_)) access_.chunk = {0, 0, 0};
    }
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return access_; }
  bool in_memory() const override {
    return std::ranges::all_of(components_, [](const auto& component) { return component->in_memory(); });
  }
  std::uint64_t bytes_read() const override {
    std::uint64_t bytes = 0;
    for (const auto& component : components_) bytes += component->bytes_read();
    return bytes;
  }
  std::uint64_t working_bytes() const override {
    const auto pieces = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    std::uint64_t bytes = pieces * static_cast<std::uint64_t>(piece_voxels()) * kMagnitudeVoxelBytes;
    for (const auto& component : components_) bytes += component->working_bytes();
    return bytes;
  }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::vector<Box> pieces = pieces_of(box);
    ConversionLoss all;
    std::mutex adding;
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
      const ConversionLoss loss = read_piece(pieces[i], false, box, values);
      const std::lock_guard lock(adding);
      all.add(loss);
    });
    return all;
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    ConversionLoss all;
    for (const Box& piece : pieces_of(box)) all.add(read_piece(piece, true, box, values));
    return all;
  }

 private:
  bool by_chunks() const { return access_.chunk != Index3{0, 0, 0} && volume(access_.chunk) <= kLargestChunk; }
  std::int64_t piece_voxels() const { return by_chunks() ? volume(access_.chunk) : kPieceVoxels + info_.extent.x; }

  // Returns the parts of `box` in each chunk, or whole rows of the box.
  std::vector<Box> pieces_of(const Box& box) const {
    const Index3 e = box.extent();
    Index3 size = access_.chunk;
    Index3 origin = access_.chunk_origin;
    if (!by_chunks()) {
      const std::int64_t rows = std::clamp<std::int64_t>(kPieceVoxels / e.x, 1, e.y);
      size = {e.x, rows, rows < e.y ? 1 : std::clamp<std::int64_t>(kPieceVoxels / (e.x * e.y), 1, e.z)};
      origin = box.lo;
    }
    const auto first = [](std::int64_t at, std::int64_t from, std::int64_t step) { return floor_div(at - from, step); };
    std::vector<Box> pieces;
    for_each_index(
        {{first(box.lo.x, origin.x, size.x), first(box.lo.y, origin.y, size.y), first(box.lo.z, origin.z, size.z)},
         {first(box.hi.x - 1, origin.x, size.x) + 1, first(box.hi.y - 1, origin.y, size.y) + 1,
          first(box.hi.z - 1, origin.z, size.z) + 1}},
        [&](const Index3& at) {
          const Index3 lo = origin + Index3{at.x * size.x, at.y * size.y, at.z * size.z};
          pieces.push_back(intersect({lo, lo + size}, box));
        });
    return pieces;
  }

  ConversionLoss read_piece(const Box& box, bool alone, const Box& whole, std::span<float> values) {
    Piece piece(static_cast<std::size_t>(box.voxels()));
    LengthLoss loss(static_cast<std::uint64_t>(box.voxels()));
    for (const auto& component : components_) {
      // While this thread waits inside, it must not start another piece: that piece's memory is not counted.
      tbb::this_task_arena::isolate([&] {
        loss.add_component(alone ? component->read_alone(box, piece.component())
                                 : component->read(box, piece.component()));
      });
      piece.add(info_.mapping.marks_missing());
    }
    loss.add_root(piece.take_lengths());
    const Index3 e = box.extent();
    for (std::int64_t row = 0; row < e.y * e.z; ++row) {
      const Index3 at = Index3{box.lo.x, box.lo.y + row % e.y, box.lo.z + row / e.y} - whole.lo;
      std::copy_n(piece.component().begin() + row * e.x, e.x, values.begin() + linear_index(at, whole.extent()));
    }
    return loss.of_lengths();
  }

  std::vector<std::unique_ptr<VolumeSource>> components_;
  SourceInfo info_;
  AccessShape access_;
};

}  // namespace

std::unique_ptr<VolumeSource> magnitude_of(std::vector<std::unique_ptr<VolumeSource>> components) {
  SourceInfo info = components.front()->info();
  info.grid_class = GridClass::unknown;
  info.background.reset();
  info.lengths = true;
  info.details.component = "magnitude";
  info.details.long_name.clear();
  info.details.chunks_note = lacking_chunks(components);
  std::string digests = info.files_digest;
  bool several = !digests.empty();
  for (std::size_t i = 1; i < components.size(); ++i) {
    const SourceInfo& other = components[i]->info();
    check_same_voxels(components.front()->info(), other);
    check_same_places(components.front()->info(), other);
    check_same_units(components.front()->info(), other);
    info.dataset += ',' + other.dataset;
    if (other.units != info.units) info.units.clear();
    for (const StoredValue& value : other.mapping.missing) {
      if (std::ranges::find(info.mapping.missing, value) == info.mapping.missing.end()) {
        info.mapping.missing.push_back(value);
      }
    }
    add_files(other, info);
    digests += '\n' + other.files_digest;
    several = several || !other.files_digest.empty();
  }
  if (several) info.files_digest = piece_digest(std::as_bytes(std::span(digests))).hex();
  info.mapping.scale = 1;
  info.mapping.offset = 0;
  return std::make_unique<MagnitudeSource>(std::move(components), std::move(info));
}

}  // namespace weir
