#include "ingest/source_registry.h"

#include <algorithm>
#include <array>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/amrex/amrex_source.h"
#include "ingest/drivers/hdf5_driver.h"
#include "ingest/drivers/hdf5_signature.h"
#include "ingest/files/input_directory.h"
#include "ingest/files/input_file.h"
#include "ingest/meta_image/meta_image_source.h"
#include "ingest/nifti/nifti_source.h"
#include "ingest/nrrd/nrrd_source.h"
#include "ingest/raw/raw_source.h"
#include "ingest/raw/stack_source.h"
#include "ingest/source/source_view.h"
#include "ingest/vdb/nvdb_source.h"
#include "ingest/vdb/vdb_source.h"
#include "ingest/vectors/magnitude_source.h"
#include "ingest/vtk/vtk_legacy_source.h"
#include "ingest/vtk/vtk_xml_source.h"
#include "ingest/zarr/zarr_source.h"

namespace weir {
namespace {

std::vector<DatasetInfo> list_raw(const std::string& path, const SourceOptions& options) {
  return list_single(open_raw(path, options)->info(), "contiguous");
}

/// Other zip files may hold arrays that are no volumes, so they are not watched.
constexpr std::array<std::string_view, 2> kWatchedZarrEndings{".zarr.zip", ".ozx"};

constexpr std::array kFormats{
    SourceFormat{.name = "nrrd",
                 .recognises = recognises_nrrd,
                 .open = open_nrrd,
                 .list = list_nrrd,
                 .container = true,
                 .watched_endings = kNrrdEndings},
    SourceFormat{.name = "meta-image",
                 .recognises = recognises_meta_image,
                 .open = open_meta_image,
                 .list = list_meta_image,
                 .container = true,
                 .watched_endings = kMetaImageEndings},
    SourceFormat{.name = "nifti",
                 .recognises = recognises_nifti,
                 .open = open_nifti,
                 .list = list_nifti,
                 .container = true,
                 .watched_endings = kNiftiEndings},
    SourceFormat{.name = "openvdb",
                 .recognises = recognises_vdb,
                 .open = open_vdb,
                 .list = list_vdb,
                 .container = true,
                 .vectors = true,
                 .watched_endings = kVdbEndings},
    SourceFormat{
        .name = "nanovdb", .recognises = recognises_nvdb, .open = open_nvdb, .list = list_nvdb, .container = true},
    SourceFormat{.name = "vtk-xml",
                 .recognises = recognises_vtk_xml,
                 .open = open_vtk_xml,
                 .list = list_vtk_xml,
                 .container = true,
                 .vectors = true,
                 .watched_endings = kVtkXmlEndings},
    SourceFormat{.name = "vtk-legacy",
                 .recognises = recognises_vtk_legacy,
                 .open = open_vtk_legacy,
                 .list = list_vtk_legacy,
                 .container = true,
                 .vectors = true,
                 .watched_endings = kVtkLegacyEndings},
    SourceFormat{.name = "amrex",
                 .recognises = recognises_amrex,
                 .open = open_amrex,
                 .list = list_amrex,
                 .container = true,
                 .directory = true,
                 .levels = count_amrex_levels},
    SourceFormat{.name = "zarr",
                 .recognises = recognises_zarr,
                 .open = open_zarr,
                 .list = list_zarr,
                 .container = true,
                 .vectors = true,
                 .directory = true,
                 .chunks = true,
                 .watched_endings = kWatchedZarrEndings},
    // HDF5 is asked late, because its signature may lie anywhere behind a user block.
    SourceFormat{.name = "hdf5",
                 .recognises = recognises_hdf5,
                 .open = open_by_hdf5_driver,
                 .list = list_by_hdf5_driver,
                 .container = true,
                 .vectors = true,
                 .chunks = true,
                 .watched_endings = kHdf5Endings},
    // A raw file has no magic number, so raw takes every file that no other format recognises.
    SourceFormat{.name = "raw",
                 .recognises = [](std::string_view, std::span<const std::byte>) { return true; },
                 .open = open_raw,
                 .list = list_raw,
                 .raw_shape = true},
};

/// Returns the one position that options.index_choices stand for in `path`. Throws Error(usage) if there are several.
std::vector<std::int64_t> chosen_position(const std::string& path, const SourceFormat& format,
                                          const SourceOptions& options) {
  const auto positions = index_positions(path, format.list(path, options), options).positions;
  if (positions.size() == 1) return positions.front();
  throw usage_error(compose(path, ": ", option("index"), " stands for ", positions.size(),
                            " volumes, and one is read here; give one position on each axis"));
}

std::unique_ptr<VolumeSource> open_file(const std::string& path, const SourceOptions& options);

std::unique_ptr<VolumeSource> open_magnitude(const std::string& path, const SourceOptions& options) {
  if (options.keeps_missing) {
    throw Error(ErrorKind::usage, compose(path, ": ", option("magnitude"), " makes no length of values that stand for ",
                                          "\"no data\"; leave out ", option("missing-policy", "keep")));
  }
  std::vector<std::unique_ptr<VolumeSource>> components;
  SourceOptions of_one = options;
  of_one.magnitude.clear();
  for (const std::string& dataset : options.magnitude) {
    of_one.dataset = dataset;
    components.push_back(open_file(path, of_one));
  }
  return magnitude_of(std::move(components));
}

std::unique_ptr<VolumeSource> open_file(const std::string& path, const SourceOptions& options) {
  const SourceFormat& format = format_of(path);
  refuse_foreign_options(path, format, options);
  if (!options.magnitude.empty()) return open_magnitude(path, options);
  if (options.dataset.find('\n') != std::string::npos) {
    throw usage_error(compose(path, ": ", option("dataset"), " is given more than once, and one volume is read here"));
  }
  if (options.index_choices.empty() || !options.index.empty()) return format.open(path, options);
  SourceOptions chosen = options;
  chosen.index = chosen_position(path, format, options);
  return format.open(path, chosen);
}

/// Throws Error(input) if `path` is a directory and its head file (kDirectoryHeads) is not a regular file.
void refuse_irregular_head(const std::string& path) {
  const auto head = irregular_head(path);
  if (head) throw input_error(head->path, head->what);
}

}  // namespace

std::span<const SourceFormat> source_formats() { return kFormats; }

const SourceFormat& format_of(const std::string& path) {
  std::array<std::byte, kMagicBytes> bytes{};
  const auto directory = head_in_directory(path);
  if (!directory) refuse_irregular_head(path);
  InputFile file(directory.value_or(path), DirectIo::off);
  const auto head = std::span(bytes).first(std::min<std::uint64_t>(kMagicBytes, file.size()));
  file.read_buffered(0, head, ReadPath::through);
  const auto format = std::find_if(kFormats.begin(), kFormats.end(), [&](const SourceFormat& f) {
    return (f.directory || !directory) && f.recognises(path, head);
  });
  if (format == kFormats.end()) {
    throw input_error(path, "is a directory, and its Header is not that of an AMReX plotfile; name a file in it");
  }
  return *format;
}

void refuse_foreign_options(const std::string& path, const SourceFormat& format, const SourceOptions& options) {
  const auto refuse = [&](bool given, const Message& what, std::string_view meant) {
    if (!given) return;
    throw Error(ErrorKind::usage,
                compose(path, ": ", what, " is for ", meant, ", and this is ", format.name, "; leave it out"));
  };
  if (!format.raw_shape) {
    refuse(options.extent.has_value(), option("dims"), "raw files");
    refuse(options.type.has_value(), option("type"), "raw files");
    refuse(options.big_endian.has_value(), option("endian"), "raw files");
    refuse(options.offset.has_value(), option("offset"), "raw files");
  }
  if (!format.container) {
    refuse(!options.dataset.empty(), option("dataset"), "files that hold several volumes");
    refuse(!options.magnitude.empty(), option("magnitude"), "files that hold several volumes");
    refuse(!options.index.empty() || !options.index_choices.empty(), option("index"), "arrays of more than three axes");
  }
  if (!format.vectors)
    refuse(options.component.has_value(), option("component"),
           "arrays of vectors in HDF5, Zarr, VTK and OpenVDB files");
  if (format.levels == nullptr) {
    refuse(options.levels != Levels::composite, option("levels", "separate"), "AMReX plotfiles");
    refuse(options.level.has_value(), option("level"), "AMReX plotfiles");
    refuse(options.upsampling.has_value(), option("upsample"), "AMReX plotfiles");
  }
  if (!format.chunks) {
    refuse(options.missing_chunks != MissingChunks::fill, option("missing-chunks", "error"),
           "Zarr arrays and HDF5 files");
  }
}

bool is_nanovdb(const std::string& path) { return format_of(path).name == "nanovdb"; }

std::unique_ptr<VolumeSource> open_source(const std::string& named, const SourceOptions& options) {
  const std::string path = without_last_slash(named);
  auto source =
      place_source(options.stack ? open_stack(path, options, open_source) : open_file(path, options), options);
  const ScalarType type = source->info().type;
  if (options.missing && !holds(type, *options.missing)) {
    throw Error(ErrorKind::usage, compose(path, ": ", option("missing"), " is ", stored_value_text(*options.missing),
                                          ", and no ", scalar_name(type), " is; give a value of that type"));
  }
  if (!options.roi) return source;
  return crop_to(std::move(source), *options.roi);
}

}  // namespace weir
