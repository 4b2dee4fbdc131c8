// Tests that each format is recognised and opened, and that options of other formats are refused.
#include "ingest/source_registry.h"

#include <sys/stat.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/output/output_place.h"
#include "tests/ingest/hdf5/support/chunked_file.h"
#include "tests/ingest/support/scratch.h"
#include "tests/stock/openvdb_file.h"
#include "tests/support/plotfile_writer.h"

namespace weir::source_registry_test {
namespace {

constexpr Index3 kExtent{4, 3, 2};

/// Writes `header` and then the bytes 0 to 23. Returns the path of the file.
std::string write_with_header(const Scratch& scratch, const std::string& name, const std::string& header) {
  std::vector<std::byte> bytes(header.size() + 24);
  std::memcpy(bytes.data(), header.data(), header.size());
  for (std::size_t i = 0; i < 24; ++i) bytes[header.size() + i] = static_cast<std::byte>(i);
  return scratch.write(name, bytes);
}

test::OpenVdbGrid ramp_grid() {
  test::OpenVdbGrid grid(test::GridKind::float32, "sample");
  for (std::int64_t i = 0; i < 24; ++i) grid.set_on(index_at(i, kExtent), static_cast<double>(i));
  return grid;
}

/// Functions that write a sample of each format and return its path. All samples hold the values 0 to 23 in 4 x 3 x 2
/// voxels.
const std::map<std::string_view, std::function<std::string(const Scratch&)>> kSamples{
    {"nrrd",
     [](const Scratch& scratch) {
       return write_with_header(scratch, "sample.nrrd",
                                "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n\n");
     }},
    {"meta-image",
     [](const Scratch& scratch) {
       return write_with_header(scratch, "sample.mha",
                                "NDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n");
     }},
    {"nifti",
     [](const Scratch& scratch) {
       std::string header(352, '\0');
       const auto put = [&](std::size_t at, std::string_view text) { header.replace(at, text.size(), text); };
       put(0, {"\x5C\x01\0\0", 4});               // sizeof_hdr 348
       put(40, {"\x03\0\x04\0\x03\0\x02\0", 8});  // dim
       put(70, {"\x02\0", 2});                    // datatype uint8
       put(108, {"\0\0\xB0\x43", 4});             // vox_offset 352
       put(344, {"n+1\0", 4});
       return write_with_header(scratch, "sample.nii", header);
     }},
    {"openvdb",
     [](const Scratch& scratch) {
       test::write_vdb(scratch.path("sample"), {ramp_grid()});
       return scratch.path("sample");
     }},
    {"nanovdb",
     [](const Scratch& scratch) {
       test::write_nvdb(scratch.path("sample"), ramp_grid());
       return scratch.path("sample");
     }},
    {"vtk-xml",
     [](const Scratch& scratch) {
       const std::string header =
           "<VTKFile type='ImageData' byte_order='LittleEndian'><ImageData WholeExtent='0 3 0 2 0 1'>"
           "<Piece Extent='0 3 0 2 0 1'><PointData><DataArray type='UInt8' format='appended' offset='0'/>"
           "</PointData></Piece></ImageData><AppendedData encoding='raw'>_";
       return write_with_header(scratch, "sample", header + std::string("\x18\0\0\0", 4));
     }},
    {"vtk-legacy",
     [](const Scratch& scratch) {
       return write_with_header(scratch, "sample",
                                "# vtk DataFile Version 3.0\n\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 2\n"
                                "POINT_DATA 24\nSCALARS a unsigned_char\nLOOKUP_TABLE default\n");
     }},
    {"hdf5",
     [](const Scratch& scratch) {
       std::vector<std::uint8_t> values(24);
       std::iota(values.begin(), values.end(), std::uint8_t{0});
       std::string path = scratch.path("sample");
       ChunkedFile(path, {{2, 3, 4}, {2, 3, 4}, {}, false, H5T_STD_U8LE}).write(H5T_NATIVE_UINT8, values);
       return path;
     }},
    {"amrex",
     [](const Scratch& scratch) {
       test::PlotfilePlan plan;
       plan.domain = {{0, 0, 0}, kExtent};
       plan.boxes = {{{{0, 0, 0}, {4, 3, 1}}, {{0, 0, 1}, {4, 3, 2}}}};
       plan.value = [](std::size_t, std::size_t, const Index3& i) {
         return static_cast<double>(linear_index(i, kExtent));
       };
       test::write_plotfile(scratch.path("plt00001"), plan);
       return scratch.path("plt00001");
     }},
    {"zarr",
     [](const Scratch& scratch) {
       std::vector<std::uint8_t> values(24);
       std::iota(values.begin(), values.end(), std::uint8_t{0});
       std::filesystem::create_directory(scratch.path("run.zarr"));
       const std::string_view metadata =
           R"({"zarr_format":2,"shape":[2,3,4],"chunks":[2,3,4],"dtype":"|u1","order":"C","fill_value":0})";
       scratch.write("run.zarr/.zarray", std::as_bytes(std::span(metadata)));
       scratch.write_values("run.zarr/0.0.0", values);
       return scratch.path("run.zarr");
     }},
    {"raw", [](const Scratch& scratch) {
       std::vector<std::uint8_t> values(24);
       std::iota(values.begin(), values.end(), std::uint8_t{0});
       return scratch.write_values("sample_4x3x2_uint8.raw", values);
     }}};

TEST(SourceRegistry, FileThatIsNotWhatItsNameSays_IsNotTakenForRaw) {
  const Scratch scratch;
  const std::string not_as_named = ": the file is of another format than its name says, or its beginning is lost";
  SourceOptions options;
  options.dataset = "density";
  for (const auto& [name, lacks] :
       std::vector<std::pair<std::string, std::string>>{{"a.nrrd", "does not begin with NRRD000"},
                                                        {"a.NHDR", "does not begin with NRRD000"},
                                                        {"a.zarr.zip", "does not begin with PK, as zip files do"},
                                                        {"a.ozx", "does not begin with PK, as zip files do"}}) {
    const std::string path = scratch.write(name, std::vector<std::byte>(5000, std::byte{0xA5}));
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, options); }),
              path + ": " + lacks + not_as_named);
  }
}

TEST(SourceRegistry, OpensEveryFormat) {
  const Scratch scratch;
  std::vector<float> expected(24);
  std::iota(expected.begin(), expected.end(), 0.0F);
  for (const SourceFormat& format : source_formats()) {
    SCOPED_TRACE(format.name);
    ASSERT_TRUE(kSamples.contains(format.name)) << "no sample of this format in the test";
    const std::string path = kSamples.at(format.name)(scratch);
    const auto source = open_source(path, {});
    EXPECT_EQ(source->info().format, format.name);
    EXPECT_EQ(source->info().path, path);
    EXPECT_EQ(source->info().extent, kExtent);
    if (!format.directory) {
      EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
    }
    std::vector<float> values(24);
    source->read(source->info().domain(), values);
    EXPECT_EQ(values, expected);

    SourceOptions options;
    options.roi = Box{{1, 1, 1}, {3, 2, 2}};
    options.spacing = {2.0, 3.0, 4.0};
    const auto part = open_source(path, options);
    EXPECT_EQ(part->info().index_origin, (Index3{1, 1, 1}));
    EXPECT_EQ(part->info().spacing, (std::array<double, 3>{2.0, 3.0, 4.0}));
    part->read(part->info().domain(), std::span(values).first(2));
    EXPECT_EQ(values[0], 17.0F);
    EXPECT_EQ(values[1], 18.0F);
  }
}

TEST(SourceRegistry, Directories_WithoutAKnownHeader_AreRefused) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.path("run"));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(scratch.path("run"), {}); }),
            scratch.path("run") + ": is a directory; name a file in it");
  scratch.write("run/Header", std::as_bytes(std::span(std::string_view("CheckPointVersion_1.0\n"))));
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { open_source(scratch.path("run"), {}); }),
      scratch.path("run") + ": is a directory, and its Header is not that of an AMReX plotfile; name a file in it");
}

TEST(SourceRegistry, DirectoriesWhoseHeaderIsNoFile_AreRefusedByItsName) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.path("run"));
  const auto refusal = [&] {
    return message_of_error(ErrorKind::input, [&] { open_source(scratch.path("run"), {}); });
  };
  ASSERT_EQ(::mkfifo(scratch.path("run/.zarray").c_str(), 0600), 0);
  EXPECT_EQ(refusal(), scratch.path("run/.zarray") + ": is a pipe and not a regular file; copy its content to one");
  std::filesystem::remove(scratch.path("run/.zarray"));
  std::filesystem::create_symlink("/dev/null", scratch.path("run/zarr.json"));
  EXPECT_EQ(refusal(), scratch.path("run/zarr.json") + ": is a device and not a regular file; copy its content to one");
  std::filesystem::remove(scratch.path("run/zarr.json"));
  std::filesystem::create_symlink("gone", scratch.path("run/.zgroup"));
  EXPECT_EQ(refusal(), scratch.path("run/.zgroup") +
                           ": is a link to a file that is not there; fetch that file, or remove the link");
}

TEST(SourceRegistry, LevelAndUpsample_AreForFormatsThatHaveLevels) {
  const Scratch scratch;
  const std::string path = kSamples.at("nrrd")(scratch);
  SourceOptions level;
  level.level = 0;
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, level); }),
            path + ": --level is for AMReX plotfiles, and this is nrrd; leave it out");
  SourceOptions upsample;
  upsample.upsampling = Upsampling::constant;
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, upsample); }),
            path + ": --upsample is for AMReX plotfiles, and this is nrrd; leave it out");
}

TEST(SourceRegistry, MissingChunks_IsForFormatsWhoseChunksMayBeMissing) {
  const Scratch scratch;
  const std::string path = kSamples.at("nrrd")(scratch);
  SourceOptions options;
  options.missing_chunks = MissingChunks::error;
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, options); }),
            path + ": --missing-chunks error is for Zarr arrays and HDF5 files, and this is nrrd; leave it out");
}

TEST(SourceRegistry, MissingFilesAreAnErrorOfTheInput) {
  const Scratch scratch;
  const std::string path = scratch.path("none_4x3x2_uint8.raw");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path + ": cannot open for reading: No such file or directory");
}

TEST(SourceRegistry, ExtensionsInCapitals_AreThoseInSmallLetters) {
  const Scratch scratch;
  // Only the name tells the format of these files.
  const auto format = [&](const std::string& name) {
    return format_of(scratch.write(name, std::vector<std::byte>(24))).name;
  };
  for (const auto& [name, expected] : std::vector<std::pair<std::string, std::string>>{{"a.NRRD", "nrrd"},
                                                                                       {"a.NHDR", "nrrd"},
                                                                                       {"a.MHD", "meta-image"},
                                                                                       {"a.MHA", "meta-image"},
                                                                                       {"a.NII", "nifti"},
                                                                                       {"a.NII.GZ", "nifti"},
                                                                                       {"a.VDB", "openvdb"},
                                                                                       {"a.NVDB", "nanovdb"},
                                                                                       {"a.VTI", "vtk-xml"},
                                                                                       {"a.VTK", "vtk-legacy"},
                                                                                       {"a.ZARR.ZIP", "zarr"},
                                                                                       {"a.H5", "hdf5"},
                                                                                       {"a.HDF5", "hdf5"},
                                                                                       {"a.Nc4", "hdf5"},
                                                                                       {"a.RAW", "raw"}}) {
    EXPECT_EQ(format(name), expected) << name;
  }
  // The values of this raw file begin with the same bytes as a zip file.
  std::vector<std::byte> bytes(24);
  std::memcpy(bytes.data(), "PK\3\4", 4);
  EXPECT_EQ(open_source(scratch.write("Scan_4x3x2_uint8.RAW", bytes), {})->info().extent, kExtent);
}

TEST(SourceRegistry, EveryWatchedEnding_IsRecognisedAsItsFormat) {
  const Scratch scratch;
  for (const SourceFormat& format : source_formats()) {
    for (const std::string_view ending : format.watched_endings) {
      const std::string path = scratch.write(cat("a", ending), std::vector<std::byte>(24));
      EXPECT_EQ(format_of(path).name, format.name) << ending;
    }
  }
}

TEST(SourceRegistry, NoResultIsWrittenToTheNameOfAWatchedFormat) {
  for (const SourceFormat& format : source_formats()) {
    for (const std::string_view ending : format.watched_endings) {
      EXPECT_THROW(require_volume_name(cat("result", ending)), Error) << ending;
    }
  }
  EXPECT_NO_THROW(require_volume_name("result.nvdb"));
}

}  // namespace
}  // namespace weir::source_registry_test
