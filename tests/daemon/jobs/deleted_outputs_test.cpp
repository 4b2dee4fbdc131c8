// Tests the conditions on the outputs of a source that is deleted.
#include <gtest/gtest.h>

#include <filesystem>

#include "daemon/jobs/source_deletion.h"
#include "tests/daemon/support/deleting_watch.h"

namespace weir::deleted_outputs_test {
namespace {

namespace fs = std::filesystem;

using DeletedOutputsTest = DeletingWatch;

TEST_F(DeletedOutputsTest, WithAnotherSourcesCertificate_Stays) {
  write_file(sidecar_path(output_), R"({"source": {"path": "/other.raw", "bytes": 6}})");
  delete_done();
  EXPECT_TRUE(stays());
}

TEST_F(DeletedOutputsTest, LosslessFileOfRoundedValues_Stays) {
  write_output(R"(}, "error": {"lossless": true}, "conversion_loss": {"inexact": 2, "overflow": 0)");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("2 values were rounded to float32, so the output is not lossless"));
}

TEST_F(DeletedOutputsTest, ValuesThatBecameInfinite_Stay) {
  write_output(R"(}, "error": {"lossless": false}, "conversion_loss": {"inexact": 0, "overflow": 1)");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("1 value is infinite in float32"));
}

TEST_F(DeletedOutputsTest, WithoutItsOutput_Stays) {
  delete_done();
  fs::remove(output_);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(output_ + " is not there as it was"));
}

TEST_F(DeletedOutputsTest, WithoutACertificate_Stays) {
  write_file(sidecar_path(output_), "{");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(sidecar_path(output_) + " cannot be read"));
}

TEST_F(DeletedOutputsTest, FileWithOtherValues_Stays) {
  write_output(R"(, "format": "hdf5", "values": 12)");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(
      logged("its outputs have 6 of the 12 values in it, and what else it holds would go with it; keep sources, "
             "or write that to another file"));
}

TEST_F(DeletedOutputsTest, FileWhoseValuesAreAllConverted_IsDeleted) {
  write_output(R"(, "format": "hdf5", "values": 6)");
  delete_done();
  EXPECT_FALSE(stays());
}

// The conversion ran before the watch was set to delete its sources.
TEST_F(DeletedOutputsTest, FileWhoseValuesWereNotCounted_Stays) {
  write_output(R"(, "format": "nifti")");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(sidecar_path(output_) + " does not say what else the file holds; let its job be done again "
                                             "(weir retry --force 1)"));
}

TEST_F(DeletedOutputsTest, RegionOfARawFile_KeepsItsSource) {
  write_output(R"(, "extent": [1, 2, 2])");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("its outputs have 4 of the 6 values in it, and what else it holds would go with it"));
}

// Another conversion has replaced the file by one of the same size.
TEST_F(DeletedOutputsTest, CertificateOfAnotherVolume_KeepsTheSource) {
  write_output(R"(}, "value_range": [0, 2.5], "error": {"max_abs": 0)");
  deletion_.configure(config_);
  deletion_.done(convert(2.25));
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(sidecar_path(output_) + " is of another volume than the job's"));
  store_.retry(1, true);
  deletion_.done(convert(2.5));
  EXPECT_FALSE(stays());
}

// Neither file is written to: an output may be read-only, or a link to its new place.
TEST_F(DeletedOutputsTest, OutputThatCannotBeWritten_IsNoObstacle) {
  fs::permissions(output_, fs::perms::owner_read);
  fs::rename(sidecar_path(output_), directory_ / "moved.json");
  fs::create_symlink(directory_ / "moved.json", sidecar_path(output_));
  delete_done();
  EXPECT_FALSE(stays()) << read_file(directory_ / "log");
}

TEST_F(DeletedOutputsTest, ValuesInSeveralFiles_Stay) {
  write_output(", \"files_digest\": \"0123456789abcdef\"");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("its values lie in several files, which other headers may name"));
}

}  // namespace
}  // namespace weir::deleted_outputs_test
