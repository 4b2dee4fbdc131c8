#include "ingest/zarr/store/zip_directory.h"

#include <algorithm>
#include <cstdint>

#include "ingest/zarr/store/zip_store.h"
#include "tests/ingest/zarr/support/zarr_files.h"
#include "tests/support/python.h"

namespace weir::zip_directory_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

/// A file of the program zip with one entry, a/b, that holds "ab" uncompressed.
constexpr std::string_view kZip(
    "PK\3\4\x14\0\0\0\0\0\0\0!\0m\x48\x83\x9e\2\0\0\0\2\0\0\0\3\0\0\0a/bab"
    "PK\1\2\x14\3\x14\0\0\0\0\0\0\0!\0m\x48\x83\x9e\2\0\0\0\2\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\x80\1\0\0\0\0a/b"
    "PK\5\6\0\0\0\0\1\0\1\0\x31\0\0\0\x23\0\0\0\0\0",
    35 + 49 + 22);
constexpr std::size_t kCentral = 35;
constexpr std::size_t kEnd = kCentral + 49;

ZipBytes bytes_in(const std::string& zip) {
  return {zip.size(), [&zip](std::uint64_t offset, std::span<std::byte> into) {
            ASSERT_LE(offset + into.size(), zip.size());
            std::copy_n(reinterpret_cast<const std::byte*>(zip.data()) + offset, into.size(), into.begin());
          }};
}

std::string refusal(const std::string& zip, ErrorKind kind = ErrorKind::input, std::uint64_t memory = kMiB) {
  return message_of_error(kind, [&] {
    const ZipBytes bytes = bytes_in(zip);
    for (const auto& [name, entry] : read_zip_directory(bytes, memory, "z"))
      zip_entry_begin(bytes, name, entry, "z: " + name);
  });
}

TEST(ZipDirectory, EntriesAreFound) {
  const std::string zip(kZip);
  const ZipBytes bytes = bytes_in(zip);
  const ZipEntries entries = read_zip_directory(bytes, kMiB, "z");
  ASSERT_EQ(entries.size(), 1U);
  const ZipEntry& entry = entries.at("a/b");
  EXPECT_EQ(entry.bytes, 2U);
  EXPECT_EQ(entry.crc, 0x9E83486DU);
  EXPECT_EQ(zip_entry_begin(bytes, "a/b", entry, "z"), 33U);
  EXPECT_EQ(read_zip_directory(bytes_in(zip + ""), kMiB, "z").size(), 1U);
}

TEST(ZipDirectory, DamageIsReported) {
  std::string zip(kZip);
  EXPECT_EQ(refusal("PK\5\6"), "z: has 4 bytes and no directory of a zip file; the zip file is cut short or damaged");
  EXPECT_EQ(refusal(zip.substr(0, zip.size() - 1)),
            "z: has no directory of a zip file at its end; the zip file is cut short or damaged");
  EXPECT_EQ(refusal(zip.substr(1)),
            "z: its directory is said to have 49 bytes at 35, and ends at 83; the zip file is cut short or damaged");
  zip[kCentral + 28] = 100;
  EXPECT_EQ(refusal(zip), "z: entry 0 of its directory is cut; the zip file is cut short or damaged");
  zip = kZip;
  zip[kCentral] = 'Q';
  EXPECT_EQ(refusal(zip),
            "z: 49 of the 49 bytes of its directory are no entries; the zip file is cut short or damaged");
  zip = kZip;
  zip[kCentral + 20] = zip[kCentral + 24] = 127;
  EXPECT_EQ(refusal(zip),
            "z: a/b: has 127 bytes at 33, beyond the 106 of the file; the zip file is cut short or damaged");
  zip = kZip;
  zip[kCentral + 42] = 1;
  EXPECT_EQ(refusal(zip), "z: a/b: has no header at 1; the zip file is cut short or damaged");
}

TEST(ZipDirectory, EntryAtTheHeaderOfAnother_IsReported) {
  std::string zip(kZip);
  zip[kCentral + 46] = 'c';
  EXPECT_EQ(refusal(zip), "z: c/b: has the header of another entry at 0; the zip file is cut short or damaged");
  zip = kZip;
  zip[26] = 2;
  zip[28] = 1;
  EXPECT_EQ(refusal(zip), "z: a/b: has the header of another entry at 0; the zip file is cut short or damaged");
}

TEST(ZipDirectory, LargerThanTheMemory_IsRefusedBeforeItIsRead) {
  EXPECT_EQ(refusal(std::string(kZip), ErrorKind::usage, 200),
            "z: its directory of 1 entries takes 258 B, more than a sixteenth of --memory; give at least 1MiB");
  static_assert(kEnd + 22 == kZip.size());
}

TEST(ZipStore, DamagedEntries_FailTheirChecksum) {
  if (!python_has("zipfile")) GTEST_SKIP() << "python3 is not installed";
  for (const bool deflated : {false, true}) {
    const ZarrFiles files;
    files.write("zarr.json", zarr_json("[1,1,64]", "[1,1,64]"));
    files.write("c/0/0/0", std::string(64, 'a'));
    const std::string zip = files.path() + ".zip";
    ASSERT_TRUE(run_python(cat("import zipfile, sys\nz = zipfile.ZipFile(sys.argv[1] + \".zip\", \"w\", ",
                               deflated ? "zipfile.ZIP_DEFLATED" : "zipfile.ZIP_STORED",
                               ")\nfor n in [\"zarr.json\", \"c/0/0/0\"]: z.write(sys.argv[1] + \"/\" + n, n)"),
                           files.path()));
    EXPECT_EQ(ZarrFiles::read_all(*open_source(zip, {})), std::vector<float>(64, 'a'));
    std::fstream file(zip, std::ios::in | std::ios::out | std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t name = text.find("c/0/0/0");
    file.clear();
    file.seekp(static_cast<std::streamoff>(name + 7));
    file.put('b');
    file.close();
    const std::string message = message_of_error(ErrorKind::input, [&] { ZarrFiles::read_all(*open_source(zip, {})); });
    EXPECT_TRUE(message.starts_with(zip + ": c/0/0/0: its ")) << message;
    EXPECT_TRUE(message.ends_with("; the zip file is damaged")) << message;
  }
}

TEST(ZipStore, EntriesBelowAChunk_AreNotTakenForOneThatIsNotStored) {
  if (!python_has("zipfile")) GTEST_SKIP() << "python3 is not installed";
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[1,1,4]", "[1,1,2]"));
  const std::string zip = files.path() + ".zip";
  ASSERT_TRUE(
      run_python("import zipfile, sys\nz = zipfile.ZipFile(sys.argv[1] + \".zip\", \"w\")\n"
                 "z.write(sys.argv[1] + \"/zarr.json\", \"zarr.json\")\nz.writestr(\"c/0/0/1/a\", \"ab\")",
                 files.path()));
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { open_source(zip, {}); }),
      zip + ": c/0/0/1: chunk at 0, 0, 2: is a directory in the zip file and not a file; write the zip file again");
}

}  // namespace
}  // namespace weir::zip_directory_test
