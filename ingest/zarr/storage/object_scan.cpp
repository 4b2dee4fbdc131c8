#include "ingest/zarr/storage/object_scan.h"

#include <algorithm>
#include <span>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"

namespace weir {
namespace {

constexpr std::uint64_t kBitsShare = 16;  // of --memory
constexpr std::int64_t kObjectsBetweenLooks = 1024;

/// Returns the number of `objects`. Throws Error(usage) if it exceeds `most`; it may exceed 63 bits.
std::uint64_t count_objects(const Index3& objects, std::uint64_t most, const ChunkObjects& of) {
  std::uint64_t count = 1;
  for (const std::int64_t along : {objects.x, objects.y, objects.z}) {
    if (along == 0) return 0;
    if (static_cast<std::uint64_t>(along) > most / count) {
      throw usage_error(compose(of.store.shown(of.array_key), ": has ", objects.z, " x ", objects.y, " x ", objects.x,
                                " chunks, more than the ", most, " that can be kept track of with ", option("memory"),
                                "; give more, or write the array with larger chunks"));
    }
    count *= static_cast<std::uint64_t>(along);
  }
  return count;
}

}  // namespace

ObjectScan scan_objects(const ChunkObjects& objects, const ChunkGeometry& geometry, std::uint64_t memory,
                        const std::atomic<bool>* cancel) {
  ObjectScan scan;
  const auto count = static_cast<std::int64_t>(
      count_objects(geometry.objects(), std::max<std::uint64_t>(memory / kBitsShare * 8, 1), objects));
  scan.stored.resize(static_cast<std::size_t>(count));
  DigestStream states;
  for (std::int64_t i = 0; i < count; ++i) {
    if (cancel != nullptr && i % kObjectsBetweenLooks == 0 && *cancel) {
      throw Error(ErrorKind::interrupted, "interrupted");
    }
    const Index3 object = index_at(i, geometry.objects());
    const std::string key = objects.key_of(geometry.object_position(object));
    const ZarrFound found = objects.store.find(key);
    if (!found.in_its_place.empty()) {
      const ChunkPlace first = geometry.place_of(geometry.chunks_of(object).lo);
      throw input_error(objects.store.shown(key),
                        cat("chunk at ", position_text(first.corner), ": ", found.in_its_place));
    }
    const auto& state = found.object;
    if (!state) continue;
    scan.stored[static_cast<std::size_t>(i)] = true;
    scan.bytes += state->bytes;
    scan.mtime_ns = std::max(scan.mtime_ns, state->mtime_ns);
    scan.ctime_ns = std::max(scan.ctime_ns, state->ctime_ns);
    const std::string text = cat(i, ' ', state->bytes, ' ', state->mtime_ns, ' ', state->ctime_ns);
    states.update(piece_digest(std::as_bytes(std::span(text))));
  }
  scan.digest = states.digest().hex();
  return scan;
}

std::string key_by_other_separator(const ChunkObjects& objects, const ChunkGeometry& geometry, const ObjectScan& scan) {
  constexpr std::size_t kMostLooks = 4096;
  if (std::find(scan.stored.begin(), scan.stored.end(), true) != scan.stored.end()) return {};
  ChunkObjects others = objects;
  others.keys.separator = objects.keys.separator == '.' ? '/' : '.';
  for (std::size_t i = 0; i < std::min(scan.stored.size(), kMostLooks); ++i) {
    std::string key =
        others.key_of(geometry.object_position(index_at(static_cast<std::int64_t>(i), geometry.objects())));
    if (objects.store.look(key)) return key;
  }
  return {};
}

}  // namespace weir
