#include "ingest/raw/stack_source.h"

#include <algorithm>
#include <atomic>
#include <list>
#include <mutex>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_states.h"
#include "ingest/headers/number_pattern.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"
#include "ingest/raw/stack_placement.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

struct FileSlab {
  std::string path;
  Index3 origin;       ///< index of the file's first voxel, in the file's own index space
  std::int64_t z = 0;  ///< first plane in the stack
  std::int64_t planes = 0;
  bool lacks_chunks = false;
};

void check_alike(const std::string& path, const SourceInfo& info, const SourceInfo& first) {
  const auto differ = [&](std::string_view what, const std::string& found, const std::string& expected) {
    return Error(ErrorKind::input, cat(path, ": ", what, ' ', found, " differs from ", expected, " of ", first.path,
                                       "; a stack's files must be alike"));
  };
  const auto plane = [](const Index3& e) { return cat(e.x, 'x', e.y); };
  if (info.extent.x != first.extent.x || info.extent.y != first.extent.y) {
    throw differ("plane", plane(info.extent), plane(first.extent));
  }
  if (info.type != first.type) {
    throw differ("type", std::string(scalar_name(info.type)), std::string(scalar_name(first.type)));
  }
  const auto mapping = [](const ValueMapping& m) {
    std::string text = cat("scale ", m.scale, ", offset ", m.offset);
    for (const StoredValue& value : m.missing) text += cat(", missing ", stored_value_text(value));
    return text;
  };
  if (mapping(info.mapping) != mapping(first.mapping)) {
    throw differ("mapping", mapping(info.mapping), mapping(first.mapping));
  }
}

class StackSource final : public VolumeSource {
 public:
  StackSource(const std::string& pattern, const SourceOptions& options, OpenVolume open)
      : open_volume_(std::move(open)), options_(options), as_they_are_(options.spacing.has_value()) {
    // These options apply to the stack, not to its files.
    options_.stack = false;
    options_.spacing.reset();
    options_.origin.reset();
    options_.roi.reset();
    // If only a region is read, only its chunks may not be missing. look_for_chunks() checks this once the planes of
    // each file are known.
    if (options.roi) options_.missing_chunks = MissingChunks::fill;
    const std::vector<NumberedFile> files = numbered_files(pattern);
    for (const NumberedFile& file : files) {
      const std::int64_t expected = files.front().number + std::ssize(slabs_);
      if (file.number != expected) {
        throw Error(ErrorKind::input, cat(pattern, ": number ", expected, " is missing between ", files.front().number,
                                          " and ", files.back().number, "; a stack has no holes"));
      }
      add(file.path);
    }
    place();
    if (options.roi) look_for_chunks(*options.roi, options.missing_chunks);
    info_.path = pattern;
    info_.format = "stack";
    info_.files_digest = files_.digest();
    checked_volume_bytes(info_.extent, scalar_bytes(info_.type), pattern);
    choose_access();
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return access_; }
  std::uint64_t working_bytes() const override { return kOpenFiles * (kStagingBytes + working_bytes_); }
  std::uint64_t bytes_read() const override {
    const std::lock_guard lock(mutex_);
    std::uint64_t bytes = closed_bytes_read_.load();
    for (const auto& [slab, source] : open_) bytes += source->bytes_read();
    return bytes;
  }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    const auto after = [](std::int64_t z, const FileSlab& slab) { return z < slab.z; };
    const auto first = std::upper_bound(slabs_.begin(), slabs_.end(), box.lo.z, after) - 1;
    const auto last = std::upper_bound(first, slabs_.end(), box.hi.z - 1, after);
    ConversionLoss total;
    std::mutex mutex;
    for_pieces(last - first, kOpenFiles, [&](std::int64_t i) {
      const ConversionLoss loss = read_slab(static_cast<std::size_t>(first - slabs_.begin() + i), box, values);
      const std::lock_guard lock(mutex);
      total.add(loss);
    });
    return total;
  }

 private:
  /// The most open files, because each has buffers of its own.
  static constexpr std::size_t kOpenFiles = kIoThreads;

  using OpenSlab = std::pair<std::size_t, std::shared_ptr<VolumeSource>>;

  void add(const std::string& path) {
    const auto source = open_volume_(path, options_);
    const SourceInfo& info = source->info();
    files_.add(path, info.files_digest);
    if (slabs_.empty()) {
      first_ = info;
      info_ = info;
      for (std::size_t i = 0; i < 3; ++i) info_.origin[i] = first_position(info, i);
      info_.index_origin = {};
      info_.extent.z = 0;
      info_.file_bytes = 0;
      info_.details.chunks_note.clear();
      info_.files.clear();
      access_ = source->access();
    }
    note_chunks(path, info);
    check_alike(path, info, first_);
    if (!as_they_are_) {
      check_placed_alike(path, info, first_);
    } else if (info.details.time && first_.details.time && info.details.time->value != first_.details.time->value) {
      info_.details.time.reset();  // the files have no common time
    }
    planes_.push_back(stacked_planes(path, info));
    info_.files.insert(info_.files.end(), info.files.begin(), info.files.end());
    slabs_.push_back({path, info.index_origin, info_.extent.z, info.extent.z, !info.details.chunks_note.empty()});
    info_.extent.z += info.extent.z;
    info_.file_bytes += info.file_bytes;
    info_.mtime_ns = std::max(info_.mtime_ns, info.mtime_ns);
    working_bytes_ = std::max(working_bytes_, source->working_bytes());
  }

  // Adds the note of a file that lacks chunks: the first such file's note, and how many more files there are.
  void note_chunks(const std::string& path, const SourceInfo& info) {
    const std::string& note = info.details.chunks_note;
    if (note.empty()) return;
    if (lacking_++ == 0) chunks_note_ = cat(path, ": ", note);
    info_.details.chunks_note = chunks_note_;
    if (lacking_ > 1) {
      info_.details.chunks_note +=
          cat("; ", lacking_ - 1, lacking_ == 2 ? " further file lacks" : " further files lack", " chunks, too");
    }
  }

  // Looks for files that lack chunks in the region, and notes or refuses them as `missing` says. Opens at least one
  // file with the user's `missing`, so that a format without chunks refuses the option.
  void look_for_chunks(const VolumeRegion& region, MissingChunks missing) {
    const Box read = intersect(region.in(info_.domain()), info_.domain());
    lacking_ = 0;
    info_.details.chunks_note.clear();
    SourceOptions options = options_;
    options.missing_chunks = missing;
    bool opened_one = false;
    for (const FileSlab& slab : slabs_) {
      const Box planes{{0, 0, slab.z}, {info_.extent.x, info_.extent.y, slab.z + slab.planes}};
      const Box part = intersect(read, planes);
      if (part.empty() || (opened_one && !slab.lacks_chunks)) continue;
      opened_one = true;
      const Index3 corner = slab.origin - planes.lo;
      options.roi = Box{part.lo + corner, part.hi + corner};
      note_chunks(slab.path, open_volume_(slab.path, options)->info());
    }
  }

  // Places the stack by what its files say, unless the user gives a spacing.
  void place() {
    const bool backwards = stacked_backwards(planes_, !as_they_are_);
    if (backwards) {
      std::reverse(planes_.begin(), planes_.end());
      std::reverse(slabs_.begin(), slabs_.end());
      std::int64_t z = 0;
      for (FileSlab& slab : slabs_) slab.z = std::exchange(z, z + slab.planes);
    }
    if (as_they_are_) {
      info_.origin[2] = planes_.front().first;
      if (backwards) info_.details.axes[2].note = "falls: planes are read in reverse order, so that positions rise";
    } else {
      place_planes(planes_, backwards, info_);
    }
    planes_.clear();
  }

  // Chooses the chunk for the block plan. If files are small, it is a whole file, so that each file is opened once
  // per pass. Otherwise it is the file's own chunk, if chunks end where the file ends.
  void choose_access() {
    const auto alike = [&](const FileSlab& slab) { return slab.planes == slabs_.front().planes; };
    const bool regular = std::all_of(slabs_.begin(), slabs_.end() - 1, alike);
    const Index3 file{info_.extent.x, info_.extent.y, slabs_.front().planes};
    if (regular && static_cast<std::uint64_t>(volume(file)) * sizeof(float) <= kAmpleBlockBytes) {
      access_.chunk = file;
      access_.chunk_origin = {};
    } else if (access_.chunk != Index3{} && !(regular && file.z % access_.chunk.z == 0)) {
      access_.chunk = {};
    }
  }

  ConversionLoss read_slab(std::size_t i, const Box& box, std::span<float> values) {
    const FileSlab& slab = slabs_[i];
    const std::int64_t from = std::max(box.lo.z, slab.z);
    const std::int64_t to = std::min(box.hi.z, slab.z + slab.planes);
    const Index3 extent = box.extent();
    const auto part = values.subspan(static_cast<std::size_t>((from - box.lo.z) * extent.x * extent.y),
                                     static_cast<std::size_t>((to - from) * extent.x * extent.y));
    const Index3 lo{box.lo.x, box.lo.y, from - slab.z};
    return opened(i)->read({slab.origin + lo, slab.origin + lo + Index3{extent.x, extent.y, to - from}}, part);
  }

  std::shared_ptr<VolumeSource> opened(std::size_t i) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::find_if(open_.begin(), open_.end(), [&](const OpenSlab& o) { return o.first == i; });
      if (found != open_.end()) {
        open_.splice(open_.begin(), open_, found);
        return found->second;
      }
    }
    // The last reader of a file closes it, and its bytes are then counted.
    std::shared_ptr<VolumeSource> source(open_volume_(slabs_[i].path, options_).release(),
                                         [this](VolumeSource* closing) {
                                           const std::unique_ptr<VolumeSource> owned(closing);
                                           closed_bytes_read_ += owned->bytes_read();
                                         });
    if (source->info().extent != Index3{info_.extent.x, info_.extent.y, slabs_[i].planes}) {
      throw Error(ErrorKind::input, cat(slabs_[i].path, ": its extent changed while it was read; convert it again"));
    }
    const std::lock_guard lock(mutex_);
    open_.emplace_front(i, source);
    if (open_.size() > kOpenFiles) open_.pop_back();
    return source;
  }

  OpenVolume open_volume_;
  SourceOptions options_;
  const bool as_they_are_;  ///< the user gives a spacing, so files stay in the order of their numbers
  SourceInfo info_;
  SourceInfo first_;  ///< info of the first file
  AccessShape access_;
  std::vector<FileSlab> slabs_;
  std::vector<StackedPlanes> planes_;  ///< planes of the slabs, until they are placed
  std::size_t lacking_ = 0;            ///< files without some of their chunks
  std::string chunks_note_;            ///< note of the first file that lacks chunks
  FileStates files_;
  std::uint64_t working_bytes_ = 0;  ///< the most that one file needs
  mutable std::mutex mutex_;
  std::atomic<std::uint64_t> closed_bytes_read_{0};
  std::list<OpenSlab> open_;  ///< most recently used first
};

}  // namespace

std::unique_ptr<VolumeSource> open_stack(const std::string& pattern, const SourceOptions& options, OpenVolume open) {
  return std::make_unique<StackSource>(pattern, options, std::move(open));
}

}  // namespace weir
