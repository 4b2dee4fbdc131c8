// Which sidecar is of the volume that a killed commit left, also where both are of one length and head checksum.
#include "format/output/commit_leftovers.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>

#include "format/io/digest.h"
#include "format/output/output_files.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/directory_contents.h"
#include "tests/support/temporary_directory.h"

namespace weir::commit_leftovers_test {
namespace {

// `head` is in the part that the head checksum covers, `values` is not.
std::string volume(char head, char values) {
  std::string bytes(64, '\0');
  bytes[8] = head;
  bytes[40] = values;
  return bytes;
}

std::string sidecar_of(const std::string& volume) {
  Sidecar sidecar;
  sidecar.file.bytes = volume.size();
  std::memcpy(&sidecar.file.head_checksum, volume.data() + 8, 4);
  sidecar.file.digest = whole_digest(std::as_bytes(std::span(volume))).hex();
  return to_json_text(sidecar);
}

const std::string kOld = volume('h', 'o');
const std::string kNew = volume('h', 'n');  // with the head of the old one

class CommitLeftovers : public ::testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const { std::ofstream(directory_ / name) << text; }

  Listing listing() const { return listing_of(directory_.path()); }

  OwnSidecar own_sidecar(const std::string& volume) const {
    put("out.nvdb", volume);
    return find_own_sidecar(*files_, sidecar_ + ".previous", sidecar_, output_);
  }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "out.nvdb";
  std::string sidecar_ = output_ + ".json";
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

TEST_F(CommitLeftovers, VolumesOfEqualHeads_AreToldByTheirDigests) {
  put("out.nvdb.json", sidecar_of(kNew));
  put("out.nvdb", kNew);
  EXPECT_TRUE(describes(*files_, sidecar_, output_));
  put("out.nvdb", kOld);
  EXPECT_FALSE(describes(*files_, sidecar_, output_));

  put("out.nvdb.json.previous", sidecar_of(kOld));
  EXPECT_EQ(own_sidecar(kOld), OwnSidecar::previous);
  EXPECT_TRUE(belongs_back(*files_, sidecar_ + ".previous", sidecar_, output_));
  EXPECT_EQ(own_sidecar(kNew), OwnSidecar::in_place);
  EXPECT_EQ(own_sidecar(volume('h', 'x')), OwnSidecar::neither) << "either may be of it, damaged";
  EXPECT_EQ(own_sidecar(volume('x', 'o')), OwnSidecar::neither);
  std::filesystem::remove(output_);
  EXPECT_FALSE(belongs_back(*files_, sidecar_ + ".previous", sidecar_, output_));
}

TEST_F(CommitLeftovers, DamagedVolume_GetsTheSidecarThatTellsSo) {
  put("out.nvdb.json", sidecar_of(volume('n', 'n')));
  put("out.nvdb.json.previous", sidecar_of(kOld));
  EXPECT_EQ(own_sidecar(volume('h', 'x')), OwnSidecar::previous);
}

TEST_F(CommitLeftovers, OutputThatWasNotReplacedYet_IsNotCommitted) {
  put("out.nvdb.json", sidecar_of(kNew));
  put("out.nvdb.partial", commit_record(sidecar_of(kNew)));
  put("out.nvdb", kOld);
  EXPECT_FALSE(is_committed(*files_, output_));
  put("out.nvdb", kNew);
  EXPECT_TRUE(is_committed(*files_, output_));
}

TEST_F(CommitLeftovers, OverwriteAfterAKill_BeginsFromTheOldPair) {
  for (const std::string& partial : {kNew, commit_record(sidecar_of(kNew))}) {
    put("out.nvdb", kOld);
    put("out.nvdb.json", sidecar_of(kNew));
    put("out.nvdb.json.previous", sidecar_of(kOld));
    put("out.nvdb.partial", partial);
    { const OutputFiles uncommitted(*files_, output_, true); }
    EXPECT_EQ(listing(), (Listing{{"out.nvdb", kOld}, {"out.nvdb.json", sidecar_of(kOld)}}));
  }
}

TEST_F(CommitLeftovers, OverwriteAfterAKill_OldVolumeWithoutASidecarHasNone) {
  for (const std::string& partial : {kNew, commit_record(sidecar_of(kNew))}) {
    put("out.nvdb", kOld);
    put("out.nvdb.json", sidecar_of(kNew));
    put("out.nvdb.partial", partial);
    { const OutputFiles uncommitted(*files_, output_, true); }
    EXPECT_EQ(listing(), (Listing{{"out.nvdb", kOld}}));
  }
  put("out.nvdb.json", sidecar_of(kNew));
  put("out.nvdb.partial", "half of another volume");
  { const OutputFiles uncommitted(*files_, output_, true); }
  EXPECT_EQ(listing(), (Listing{{"out.nvdb", kOld}, {"out.nvdb.json", sidecar_of(kNew)}})) << "nobody knows whose";
}

}  // namespace
}  // namespace weir::commit_leftovers_test
