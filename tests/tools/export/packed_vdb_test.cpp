// Tests a packed grid that is written as .vdb: OpenVDB and weir read it.
#include <gtest/gtest.h>

#include "format/io/file_system.h"
#include "ingest/source_registry.h"
#include "tests/stock/vdb_oracle.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"
#include "tools/export/vdb_writer.h"

namespace weir::packed_vdb_test {
namespace {

using test::PackedSample;

TEST(PackedVdb, WriteVdb_PackedGrid_ReadsBackAsTheSameVoxels) {
  const test::PackedFile made = PackedSample::build();
  const TemporaryDirectory directory;
  const std::string path = directory / "out.vdb";
  const auto files = make_posix_file_system();
  const VdbWritten written = write_vdb(NvdbGrid::open(made.file, "a.nvdb"), "a.nvdb", {}, *files->create(path));
  EXPECT_EQ(written.active_voxels, static_cast<std::uint64_t>(PackedSample::kDomain.voxels()));
  EXPECT_EQ(test::read_facts(path).name, "packed");
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().domain(), PackedSample::kDomain);
  std::vector<float> values(static_cast<std::size_t>(PackedSample::kDomain.voxels()));
  source->read(PackedSample::kDomain, values);
  std::size_t next = 0;
  for_each_index(PackedSample::kDomain, [&](const Index3& i) { ASSERT_EQ(values[next++], PackedSample::value(i)); });
}

}  // namespace
}  // namespace weir::packed_vdb_test
