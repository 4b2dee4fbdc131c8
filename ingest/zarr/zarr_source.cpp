#include "ingest/zarr/zarr_source.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/space_axis.h"
#include "ingest/chunks/chunk_boxes.h"
#include "ingest/files/file_states.h"
#include "ingest/files/input_directory.h"
#include "ingest/source/reversed_source.h"
#include "ingest/zarr/array_choice.h"
#include "ingest/zarr/storage/gathered_chunks.h"
#include "ingest/zarr/store/open_store.h"
#include "ingest/zarr/store/zip_directory.h"

namespace weir {
namespace {

/// Memory for open shards, keys and metadata, in bytes.
constexpr std::uint64_t kZarrOwnBytes = std::uint64_t{2} << 20U;

ScratchSize scratch_of(const ZarrArray& array, const VoxelParts& parts) {
  ScratchSize size = scratch_size(array.values(), parts.parts.front().geometry.unit_shape().bytes());
  size.gathered_bytes = parts.gathered_bytes();
  return size;
}

ChunkedVolume volume_of(const ZarrArray& array, const VoxelParts& parts, const SourceInfo& info,
                        const std::string& where) {
  const ChunkGeometry& geometry = parts.parts.front().geometry;
  ChunkedVolume volume;
  volume.name = where;
  volume.extent = geometry.extent();
  volume.chunk = geometry.unit();
  volume.type = array.type;
  volume.big_endian = array.values().big_endian;
  volume.mapping = info.mapping;
  volume.components = parts.components;
  volume.fill = array.fill.value_or(std::vector<std::byte>(scalar_bytes(array.type)));
  return volume;
}

class ZarrSource final : public VolumeSource {
 public:
  ZarrSource(std::unique_ptr<ZarrStore> store, const ChosenArray& chosen, const VoxelParts& parts, SourceInfo info,
             const Box& wanted, const SourceOptions& options)
      : store_(std::move(store)),
        info_(std::move(info)),
        where_(store_->shown(chosen.node.key)),
        scratch_(scratch_of(chosen.array, parts), options.memory, where_),
        chunks_({*store_, chosen.node.key, chosen.array.keys}, chosen.array, parts, options.memory, options.cancel),
        boxes_(volume_of(chosen.array, parts, info_, where_), chunks_, scratch_) {
    note_unstored(chosen, wanted, options);
    note_files(chosen);
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return boxes_.access(); }
  std::uint64_t working_bytes() const override { return scratch_.bytes() + chunks_.working_bytes() + kZarrOwnBytes; }
  std::uint64_t bytes_read() const override { return chunks_.bytes_read(); }
  ConversionLoss read(const Box& box, std::span<float> values) override { return boxes_.read(box, values); }

 private:
  void note_unstored(const ChosenArray& chosen, const Box& wanted, const SourceOptions& options) {
    const ZarrArray& array = chosen.array;
    const UnstoredChunks unstored = chunks_.count_unstored(wanted);
    if (unstored.count == 0) return;
    if (const std::string other = chunks_.key_by_other_separator(); !other.empty()) {
      const std::string separators =
          array.keys.separator == '.' ? "\".\", and must be \"/\"" : "\"/\", and must be \".\"";
      throw input_error(
          unstored.first,
          cat("is not stored, nor is any other, but ", store_->shown(other), " is; ",
              chosen.node.version == 3 ? "separator of chunk_key_encoding" : "dimension_separator", " is ", separators,
              " of chunks named so; set it in ", store_->shown(chosen.node.document)));
    }
    const std::string count = cat(unstored.count, options.roi ? " of the region's " : " of its ", unstored.all,
                                  unstored.all == 1 ? " chunk" : " chunks");
    const char* const is = unstored.count == 1 ? " is" : " are";
    if (options.missing_chunks == MissingChunks::error) {
      throw input_error(unstored.first,
                        compose("is not stored; ", count, is, " not, and with ", option("missing-chunks", "error"),
                                " all must be; write it, or use ", option("missing-chunks", "fill")));
    }
    if (!array.fill) {
      throw input_error(unstored.first, cat("is not stored; ", count, is,
                                            " not, and fill_value is null: what they hold is not known; write all "
                                            "chunks, or set the array's fill_value"));
    }
    info_.details.chunks_note = cat(count, is, " not stored and ", unstored.count == 1 ? "reads" : "read",
                                    " as its fill value, ", array.fill_text);
  }

  void note_files(const ChosenArray& chosen) {
    FileStates files;
    files.add(store_->file_of(chosen.node.document), chunks_.digest());
    const FileState& state = files.files().front();
    const bool alone = store_->is_one_file();
    info_.file_bytes = alone ? state.bytes : state.bytes + chunks_.object_bytes();
    info_.mtime_ns = std::max(state.mtime_ns, chunks_.mtime_ns());
    info_.files_digest = alone ? std::string() : files.digest();
    info_.files = files.files();
  }

  std::unique_ptr<ZarrStore> store_;
  SourceInfo info_;
  std::string where_;
  ScratchPool scratch_;
  GatheredChunks chunks_;
  ChunkBoxes boxes_;
};

// A volume with time as an axis is allowed only if the user gives --spacing, the distance of its planes.
void check_obstacle(const ArrayMeaning& meaning, const SourceOptions& options, const std::string& where) {
  if (meaning.obstacle.empty() || (meaning.over_time && options.spacing)) return;
  if (!meaning.over_time) throw input_error(where, meaning.obstacle);
  throw input_error(where, compose(meaning.obstacle, "; to take the time for a length, give ", option("spacing")));
}

}  // namespace

bool recognises_zarr(std::string_view path, std::span<const std::byte> head) {
  const std::string name(path);
  const auto directory_head = head_in_directory(name);
  if (directory_head) return !is_plotfile_head(*directory_head);
  if (is_head(path)) return !is_plotfile_head(path);
  const std::string lower = lower_case(path);
  return lower.ends_with(".zip") || lower.ends_with(".ozx") || (!lower.ends_with(".raw") && begins_as_zip(head));
}

std::unique_ptr<VolumeSource> open_zarr(const std::string& path, const SourceOptions& options) {
  std::unique_ptr<ZarrStore> store = open_zarr_store(path, options.memory);
  ChosenArray chosen = choose_array(*store, path, options);
  const std::string where = store->shown(chosen.node.key);
  if (chosen.array.shape.size() <= kSpaceAxes) check_obstacle(chosen.meaning, options, where);
  choose_component(chosen.array, options.component, options.index.size(), where, chosen.meaning);
  check_obstacle(chosen.meaning, options, where);
  const auto index = checked_index(chosen.meaning, options.index, where);
  SourceInfo info;
  info.path = path;
  info.format = "zarr";
  info.dataset = chosen.node.key;
  describe_volume(chosen.array, chosen.meaning, index, info);
  options.complete(info.mapping);
  if (options.component) info.details.component = component_text(*options.component);
  info.lengths = options.component && options.component->magnitude;
  const VoxelParts parts = voxel_parts(chosen.array, index, chosen.meaning.components, options.component, where);
  std::array<bool, 3> falls{};
  for (std::size_t i = 0; i < falls.size(); ++i) falls.at(i) = chosen.meaning.volume_axes().at(i)->falls;
  const Box domain = info.domain();
  const Box wanted = options.roi ? mirrored_box(intersect(options.roi->in(domain), domain), domain, falls) : domain;
  return reverse_axes(std::make_unique<ZarrSource>(std::move(store), chosen, parts, std::move(info), wanted, options),
                      falls);
}

std::vector<DatasetInfo> list_zarr(const std::string& path, const SourceOptions& options) {
  const std::unique_ptr<ZarrStore> store = open_zarr_store(path, options.memory);
  return list_arrays(*store, path);
}

}  // namespace weir
