#include "ingest/zarr/zarr_source.h"

#include <numeric>

#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::zarr_source_test {
namespace {

constexpr const char* kGroup = R"({"zarr_format":3,"node_type":"group"})";

std::vector<std::uint8_t> counted(std::size_t count, std::uint8_t first = 0) {
  std::vector<std::uint8_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST(ZarrSource, ChunksThatAreNotStored_ReadAsTheFillValueAndAreCounted) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[2,2,3]", "[2,2,2]"));
  files.write_values("c/0/0/0", counted(8));
  const auto source = open_source(files.path(), {});
  EXPECT_EQ(ZarrFiles::read_all(*source), (std::vector<float>{0, 1, 7, 2, 3, 7, 4, 5, 7, 6, 7, 7}));
  EXPECT_EQ(source->info().details.chunks_note, "1 of its 2 chunks is not stored and reads as its fill value, 7");
  SourceOptions options;
  options.missing_chunks = MissingChunks::error;
  EXPECT_EQ(files.message(ErrorKind::input, options),
            "run.zarr/c/0/0/1: chunk at 0, 0, 2: is not stored; 1 of its 2 chunks is not, and with --missing-chunks "
            "error all must be; write it, or use --missing-chunks fill");
  files.write_values("c/0/0/1", counted(8, 100));
  EXPECT_EQ(files.read(options), (std::vector<float>{0, 1, 100, 2, 3, 102, 4, 5, 104, 6, 7, 106}));
}

TEST(ZarrSource, ChunksNamedWithTheOtherSeparator_AreNotTakenForNone) {
  // zarr-python's NestedDirectoryStore wrote such arrays before metadata named the separator.
  const ZarrFiles nested;
  nested.write(".zarray", zarray("[1,1,4]", "[1,1,2]"));
  nested.write_values("0/0/1", counted(2));
  EXPECT_EQ(nested.message(ErrorKind::input),
            cat("run.zarr/0.0.0: chunk at 0, 0, 0: is not stored, nor is any other, but ", nested.path("0/0/1"),
                " is; dimension_separator is \".\", and must be \"/\" of chunks named so; set it in ",
                nested.path(".zarray")));
  const ZarrFiles flat;
  flat.write("zarr.json", zarr_json("[1,1,4]", "[1,1,2]"));
  flat.write_values("c.0.0.0", counted(2));
  EXPECT_EQ(flat.message(ErrorKind::input),
            cat("run.zarr/c/0/0/0: chunk at 0, 0, 0: is not stored, nor is any other, but ", flat.path("c.0.0.0"),
                " is; separator of chunk_key_encoding is \"/\", and must be \".\" of chunks named so; set it in ",
                flat.path("zarr.json")));
}

TEST(ZarrSource, HierarchyNamedByItsHead_HasTheSameRecordAsByItsDirectory) {
  for (const char* head : {"zarr.json", ".zarray"}) {
    const ZarrFiles files;
    const bool old = std::string_view(head) == ".zarray";
    files.write(head, old ? zarray("[1,1,4]", "[1,1,2]") : zarr_json("[1,1,4]", "[1,1,2]"));
    files.write_values(old ? "0.0.0" : "c/0/0/0", counted(2));
    files.write_values(old ? "0.0.1" : "c/0/0/1", counted(2));
    const auto by_directory = open_source(files.path(), {});
    const auto by_head = open_source(files.path(head), {});
    EXPECT_EQ(by_head->info().file_bytes, std::filesystem::file_size(files.path(head)) + 4) << head;
    EXPECT_EQ(by_head->info().file_bytes, by_directory->info().file_bytes) << head;
    EXPECT_EQ(by_head->info().files_digest.size(), 32U) << head;
    EXPECT_EQ(by_head->info().files_digest, by_directory->info().files_digest) << head;
    EXPECT_EQ(by_head->info().mtime_ns, by_directory->info().mtime_ns) << head;
  }
}

TEST(ZarrSource, AttributesOfVersion2_CountAsMetadata) {
  const ZarrFiles files;
  files.write(".zgroup", R"({"zarr_format":2})");
  const std::string large = cat(R"({"history":")", std::string(12U << 20U, 'a'), R"("})");
  for (const char* name : {"a", "b", "c"}) {
    files.write(cat(name, "/.zarray"), zarray("[1,1,4]", "[1,1,2]"));
    files.write(cat(name, "/.zattrs"), large);
  }
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr: has more than 10000 groups and arrays, 32 groups in each other or 33554432 bytes of metadata; "
            "name a group or an array in it");
}

TEST(ZarrSource, FillValueNull_IsRefusedWhereAChunkIsNotStored) {
  const ZarrFiles files;
  files.write(".zarray", zarray("[1,1,4]", "[1,1,2]", "|u1", "null"));
  files.write_values("0.0.0", counted(2));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0.0.1: chunk at 0, 0, 2: is not stored; 1 of its 2 chunks is not, and fill_value is null: what "
            "they hold is not known; write all chunks, or set the array's fill_value");
  files.write_values("0.0.1", counted(2, 8));
  EXPECT_EQ(files.read(), (std::vector<float>{0, 1, 8, 9}));
}

TEST(ZarrSource, ChunksOutsideTheRegion_AreNotMissed) {
  const ZarrFiles files;
  files.write(".zarray", zarray("[1,1,6]", "[1,1,2]", "|u1", "null"));
  files.write_values("0.0.1", counted(2, 8));
  SourceOptions options;
  options.roi = VolumeRegion(Box{{2, 0, 0}, {4, 1, 1}});
  options.missing_chunks = MissingChunks::error;
  EXPECT_EQ(files.read(options), (std::vector<float>{8, 9}));
  options.roi = VolumeRegion(Box{{3, 0, 0}, {5, 1, 1}});
  options.missing_chunks = MissingChunks::fill;
  EXPECT_EQ(files.message(ErrorKind::input, options),
            "run.zarr/0.0.2: chunk at 0, 0, 4: is not stored; 1 of the region's 2 chunks is not, and fill_value is "
            "null: what they hold is not known; write all chunks, or set the array's fill_value");
}

TEST(ZarrSource, DamagedChunks_AreNamedByFileAndPosition) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[2,2,4]", "[2,2,2]"));
  files.write_values("c/0/0/0", counted(8));
  files.write_values("c/0/0/1", counted(7));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/1: chunk at 0, 0, 2: holds 7 bytes, not 8; the file is damaged");
  files.write_values("c/0/0/1", counted(9));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/1: chunk at 0, 0, 2: takes 9 bytes, and at most 8 can be right; the file is damaged");
  files.write("c/0/0/1", "");
  EXPECT_EQ(files.message(ErrorKind::input), "run.zarr/c/0/0/1: is empty (0 bytes); copy it again, or write it anew");
  files.write("zarr.json", zarr_json("[2,2,4]", "[2,2,2]", R"([{"name":"bytes"},{"name":"crc32c"}])"));
  files.write("c/0/0/0", std::string(12, '\0'));
  std::filesystem::remove(files.path("c/0/0/1"));  // of two, the order of threads would decide which is named
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk at 0, 0, 0: its crc32c is 00000000, its bytes give 8c28b28a; the file is damaged");
  files.write("zarr.json", zarr_json("[2,2,4]", "[2,2,2]", R"([{"name":"bytes"},{"name":"gzip"}])"));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk at 0, 0, 0: its deflate stream is damaged after 0 of 8 bytes (incorrect header "
            "check); the file is damaged");
}

TEST(ZarrSource, WhatIsNoFileInTheirPlace_IsNotTakenForAChunkThatIsNotStored) {
  const ZarrFiles files;
  files.write(".zarray", zarray("[1,1,4]", "[1,1,2]", "|u1", "7",
                                R"("compressor":null,"filters":null,"dimension_separator":"/")"));
  files.write_values("0/0/0", counted(2));
  EXPECT_EQ(files.read(), (std::vector<float>{0, 1, 7, 7}));
  std::filesystem::create_directories(files.path("0/0/1"));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0/0/1: chunk at 0, 0, 2: is a directory and not a file; copy the array again, or remove the "
            "directory");
  std::filesystem::remove(files.path("0/0/1"));
  std::filesystem::create_symlink("nowhere", files.path("0/0/1"));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0/0/1: chunk at 0, 0, 2: is a link to a file that is not there; fetch that file, or remove the "
            "link");
  std::filesystem::remove(files.path("0/0/1"));
  std::filesystem::create_symlink("0", files.path("0/0/1"));
  EXPECT_EQ(files.read(), (std::vector<float>{0, 1, 0, 1}));
  std::filesystem::remove_all(files.path("0/0"));
  files.write("0/0", "ab");
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0/0/0: chunk at 0, 0, 0: lies below a file that should be a directory; copy the array again");
}

TEST(ZarrSource, ChunksThatChangeAfterOpening_AreRefused) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[1,1,4]", "[1,1,2]"));
  files.write_values("c/0/0/0", counted(2));
  files.write_values("c/0/0/1", counted(2));
  const auto source = open_source(files.path(), {});
  std::filesystem::remove(files.path("c/0/0/1"));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { ZarrFiles::read_all(*source); }),
            files.path("c/0/0/1") +
                ": changed while it was read: it is not there any more; convert it again once nothing writes to it");
}

TEST(ZarrSource, ShardIndexThatPointsOutsideTheShard_IsRefused) {
  const ZarrFiles files;
  files.write(
      "zarr.json",
      zarr_json("[1,1,4]", "[1,1,4]",
                R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[1,1,2],"codecs":[{"name":"bytes"}],)"
                R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}]}}])"));
  const auto shard = [&](std::vector<std::uint64_t> index) {
    std::string bytes = "abcd";
    bytes.append(reinterpret_cast<const char*>(index.data()), index.size() * sizeof(std::uint64_t));
    files.write("c/0/0/0", bytes);
  };
  shard({2, 2, ~std::uint64_t{0}, ~std::uint64_t{0}});
  EXPECT_EQ(files.read(), (std::vector<float>{'c', 'd', 7, 7}));
  shard({0, 2, 35, 2});
  EXPECT_EQ(
      files.message(ErrorKind::input),
      "run.zarr/c/0/0/0: chunk 1 of the shard is said to have 2 bytes at 35, and the shard has 36 bytes; the file "
      "is damaged");
  shard({0, 2, 0, 4});
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk at 0, 0, 2: takes 4 bytes, and at most 2 can be right; the file is damaged");
  files.write("c/0/0/0", "abc");
  EXPECT_EQ(
      files.message(ErrorKind::input),
      "run.zarr/c/0/0/0: has 3 bytes, and the index of its shard alone takes 32; the file is cut short or damaged");
}

constexpr std::uint64_t kNotStored = ~std::uint64_t{0};

std::string index_text(const std::vector<std::uint64_t>& index) {
  return {reinterpret_cast<const char*>(index.data()), index.size() * sizeof(std::uint64_t)};
}

/// Each object has two inner shards, each with two chunks of two elements. An object's index is first, a shard's last.
std::string nested_zarr_json() {
  const std::string index = R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}])";
  const std::string inner = R"({"name":"sharding_indexed","configuration":{"chunk_shape":[1,1,2],)"
                            R"("codecs":[{"name":"bytes"}],)" +
                            index + "}}";
  return zarr_json("[1,1,8]", "[1,1,8]",
                   R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[1,1,4],"index_location":"start",)"
                   R"("codecs":[)" +
                       inner + "]," + index + "}}]");
}

TEST(ZarrSource, ShardsInShards_AreReadAndCounted) {
  const ZarrFiles files;
  files.write("zarr.json", nested_zarr_json());
  const std::string first = "abcd" + index_text({2, 2, 0, 2});
  const std::string second = "ef" + index_text({kNotStored, kNotStored, 0, 2});
  files.write("c/0/0/0", index_text({32, 36, 68, 34}) + first + second);
  EXPECT_EQ(files.read(), (std::vector<float>{'c', 'd', 'a', 'b', 7, 7, 'e', 'f'}));
  EXPECT_EQ(open_source(files.path(), {})->info().details.chunks_note,
            "1 of its 4 chunks is not stored and reads as its fill value, 7");

  files.write("c/0/0/0", index_text({kNotStored, kNotStored, 32, 34}) + second);
  EXPECT_EQ(files.read(), (std::vector<float>{7, 7, 7, 7, 7, 7, 'e', 'f'}));
  EXPECT_EQ(open_source(files.path(), {})->info().details.chunks_note,
            "3 of its 4 chunks are not stored and read as its fill value, 7");
  SourceOptions all;
  all.missing_chunks = MissingChunks::error;
  EXPECT_TRUE(files.message(ErrorKind::input, all).starts_with("run.zarr/c/0/0/0: chunk at 0, 0, 0: is not stored; 3"))
      << files.message(ErrorKind::input, all);
}

TEST(ZarrSource, ShardsInShardsThatPointOutside_AreRefused) {
  const ZarrFiles files;
  files.write("zarr.json", nested_zarr_json());
  files.write("c/0/0/0", index_text({32, 36, kNotStored, kNotStored}) + "abcd" + index_text({2, 2, 35, 2}) + "behind");
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk 0 of the shard: chunk 1 of the shard is said to have 2 bytes at 35, and the shard "
            "has 36 bytes; the file is damaged");
  files.write("c/0/0/0", index_text({32, 3, kNotStored, kNotStored}) + "abc");
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk 0 of the shard: has 3 bytes, and the index of its shard alone takes 32; the file "
            "is cut short or damaged");
  files.write("c/0/0/0", index_text({32, 37, kNotStored, kNotStored}) + "abcd" + index_text({2, 2, 0, 2}));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/c/0/0/0: chunk 0 of the shard is said to have 37 bytes at 32, and the shard has 68 bytes; the "
            "file is damaged");
}

TEST(ZarrSource, HostileSizes_AreRefusedBeforeMemoryIsTaken) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[100000,100000,100000]", "[65536,65536,1]"));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr: its chunks have 65536, 65536, 1 elements, more than 4227858432 bytes; write the array with "
            "smaller chunks");
  files.write("zarr.json", zarr_json("[1000,1000,1000]", "[1000,1000,500]"));
  EXPECT_EQ(files.message(ErrorKind::usage),
            "run.zarr: decoding one of its chunks of 476.8 MiB takes 476.9 MiB, more than half of --memory 512.0 MiB; "
            "give at least 954MiB");
  files.write("zarr.json", zarr_json("[200000,200000,200000]", "[1,1,1]"));
  EXPECT_EQ(files.message(ErrorKind::usage),
            "run.zarr: has 200000 x 200000 x 200000 chunks, more than the 268435456 that can be kept track of with "
            "--memory; give more, or write the array with larger chunks");
  files.write(
      "zarr.json",
      zarr_json("[4096,4096,4096]", "[4096,4096,1024]",
                R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[4,4,4],"codecs":[{"name":"bytes"}],)"
                R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}]}}])"));
  EXPECT_EQ(files.message(ErrorKind::usage),
            "run.zarr: the index of one of its shards of 268435456 chunks takes 8.0 GiB, more than a sixteenth of "
            "--memory 512.0 MiB; give at least 131073MiB");
  files.write(
      "zarr.json",
      zarr_json("[4096,4096,4096]", "[4096,4096,1024]",
                R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[4096,4096,512],"codecs":[)"
                R"({"name":"sharding_indexed","configuration":{"chunk_shape":[4,4,4],"codecs":[{"name":"bytes"}],)"
                R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}]}}],)"
                R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}]}}])"));
  EXPECT_EQ(files.message(ErrorKind::usage),
            "run.zarr: the index of one of its shards of 134217728 chunks takes 4.0 GiB, more than a sixteenth of "
            "--memory 512.0 MiB; give at least 65537MiB");
  files.write("zarr.json", zarr_json("[4,4,9223372036854775807]", "[1,1,1]"));
  EXPECT_TRUE(files.message(ErrorKind::input).starts_with("run.zarr: ")) << files.message(ErrorKind::input);
}

TEST(ZarrSource, LeadingAxes_AreChosenByIndex) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[2,2,1,1,2]", "[2,1,1,1,2]", R"([{"name":"bytes"}])", "uint8", "7",
                                     R"(,"dimension_names":["t","c",null,"y","x"])"));
  files.write_values("c/0/0/0/0/0", counted(4));
  files.write_values("c/0/1/0/0/0", counted(4, 10));
  SourceOptions options;
  options.index = {1, 1};
  EXPECT_EQ(files.read(options), (std::vector<float>{12, 13}));
  const auto source = open_source(files.path(), options);
  EXPECT_EQ(source->info().axis_labels, (std::array<std::string, 3>{"x", "y", ""}));
  EXPECT_EQ(source->info().index, (std::vector<std::int64_t>{1, 1}));
  options.index = {1};
  EXPECT_EQ(
      files.message(ErrorKind::usage, options),
      "run.zarr: its axes are t 2, c 2, 1, y 1, x 2, and --index has 1 position; give --index with 2 positions: t in "
      "0..1, c in 0..1");
  options.index = {0, 2};
  EXPECT_EQ(
      files.message(ErrorKind::usage, options),
      "run.zarr: its axes are t 2, c 2, 1, y 1, x 2, and --index has 2; give --index with 2 positions: t in 0..1, c "
      "in 0..1");
  options.index.clear();
  options.index_choices = {*parse_axis_choice("t=0"), *parse_axis_choice("c=-1")};
  EXPECT_EQ(files.read(options), (std::vector<float>{10, 11}));
}

TEST(ZarrSource, SeveralArrays_AreNamedWithTheirCommands) {
  const ZarrFiles files;
  files.write("zarr.json", kGroup);
  files.write("a/zarr.json", zarr_json("[1,1,1]", "[1,1,1]"));
  files.write("b/zarr.json", kGroup);
  files.write("b/c/zarr.json", zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "uint8", "9"));
  files.write("b/line/zarr.json", zarr_json("[4]", "[4]"));
  EXPECT_EQ(files.message(ErrorKind::usage), "run.zarr: holds 2 volumes; choose one with --dataset: weir convert " +
                                                 files.path() + " --dataset a; weir convert " + files.path() +
                                                 " --dataset b/c");
  SourceOptions options;
  options.dataset = "/b/c";
  EXPECT_EQ(files.read(options), (std::vector<float>{9}));
  options.dataset = "d";
  EXPECT_EQ(files.message(ErrorKind::input, options), "run.zarr: has no array 'd'; it has 'a', 'b/c', 'b/line'");
  options.dataset = "b/../a";
  EXPECT_EQ(files.message(ErrorKind::input, options), "run.zarr: has no array 'b/../a'; it has 'a', 'b/c', 'b/line'");
  const std::vector<DatasetInfo> list = list_zarr(files.path(), {});
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[1].name, "b/c");
  EXPECT_EQ(list[1].type, "uint8");
  EXPECT_EQ(list[1].layout, "chunked 1 x 1 x 1");
  EXPECT_EQ(list[2].obstacle, "1 axis (4); a volume has three");
}

TEST(ZarrSource, ArraysThatCannotBeRead_AreListedWithTheReason) {
  const ZarrFiles files;
  files.write(".zgroup", R"({"zarr_format":2})");
  files.write("a/.zarray", zarray("[1,1,1]", "[1,1,1]", "<c8"));
  files.write("b/.zarray", zarray("[1,1,1]", "[1,1,1]", "|u1", "300"));
  const std::vector<DatasetInfo> list = list_zarr(files.path(), {});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].type, "<c8");
  EXPECT_EQ(list[0].obstacle, "its type is <c8; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64");
  EXPECT_EQ(list[1].obstacle, "fill_value is 300, which is no uint8; the file is damaged");
  EXPECT_EQ(
      files.message(ErrorKind::input),
      "run.zarr: none of its 2 arrays is a volume; the first is a: its type is <c8; a volume has integers of 8 to "
      "64 bits or floats of 16, 32 or 64; weir inspect lists them");
}

TEST(ZarrSource, ArraysThatCannotBeRead_AreNamedBesideTheOneThatIsTaken) {
  const ZarrFiles files;
  files.write("zarr.json", kGroup);
  files.write("a/zarr.json", zarr_json("[1,1,1]", "[1,1,1]"));
  files.write("b/zarr.json", zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "complex64", "[0,0]"));
  files.write("line/zarr.json", zarr_json("[1]", "[1]"));
  std::vector<std::string> said;
  SourceOptions options;
  options.notice = [&](const Message& line) { said.push_back(line.text()); };
  EXPECT_EQ(open_source(files.path(), options)->info().dataset, "a");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].find(files.path() + ": a is read; left out: b: its type is "), 0U) << said[0];
  EXPECT_EQ(said[0].find("line"), std::string::npos) << said[0];
  options.dataset = "a";
  open_source(files.path(), options);
  EXPECT_EQ(said.size(), 1U) << "where it is named, nothing is said";
}

TEST(ZarrSource, ExtentsThatNoVolumeHas_AreListedAsTheReason) {
  const ZarrFiles files;
  files.write("zarr.json", kGroup);
  files.write("long/zarr.json", zarr_json("[1,1,2147483648]", "[1,1,1024]"));
  files.write("many/zarr.json", zarr_json("[2,1073741824,2147483647]", "[1,1024,1024]"));
  const std::vector<DatasetInfo> list = list_zarr(files.path(), {});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].obstacle, "extent 2147483648x1x1 has 2147483648 voxels along x; each axis must be 1 to 2147483647");
  EXPECT_EQ(list[1].obstacle, "extent 2147483647x1073741824x2 at 4 bytes a voxel overflows 64 bits; check the extent");
  SourceOptions options;
  options.dataset = "long";
  EXPECT_EQ(files.message(ErrorKind::input, options), "run.zarr/long: " + list[0].obstacle);
  // An array that can be converted needs no name, although the others are there.
  files.write("short/zarr.json", zarr_json("[1,1,1]", "[1,1,1]"));
  EXPECT_EQ(files.read(), (std::vector<float>{7}));
}

TEST(ZarrSource, PathsOfItsParts_OpenTheSame) {
  const ZarrFiles files;
  files.write("zarr.json", kGroup);
  files.write("a/zarr.json", zarr_json("[1,1,2]", "[1,1,2]"));
  for (const std::string& path :
       {files.path(), files.path() + "/", files.path("zarr.json"), files.path("a"), files.path("a/zarr.json")}) {
    EXPECT_EQ(ZarrFiles::read_all(*open_source(path, {})), (std::vector<float>{7, 7})) << path;
  }
}

}  // namespace
}  // namespace weir::zarr_source_test
