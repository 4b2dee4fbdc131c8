// Tests how long metadata may be, and the messages for longer metadata.
#include "ingest/zarr/metadata/zarr_json.h"
#include "ingest/zarr/zarr_source.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::zarr_limits_test {
namespace {

std::string array_with(std::string_view attributes) {
  return zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "uint8", "7",
                   cat(",\"attributes\":{", attributes, "}"));
}

std::string list_of(std::size_t zeros) {
  std::string list = "\"list\":[0";
  for (std::size_t i = 1; i < zeros; ++i) list += ",0";
  return list + "]";
}

std::string group_with(std::string_view more) { return cat(R"({"zarr_format":3,"node_type":"group")", more, "}"); }

TEST(ZarrLimits, ThousandArraysWithConsolidatedMetadata_AreListed) {
  const ZarrFiles files;
  const std::string array = array_with(R"("units":"K","long_name":"temperature","scale_factor":2,"list":[1,2,3,4,5])");
  std::string copies;
  for (int i = 0; i < 1000; ++i) {
    files.write(cat("a", i, "/zarr.json"), array);
    copies += cat(i == 0 ? "" : ",", "\"a", i, "\":", array);
  }
  files.write("zarr.json", group_with(cat(R"(,"consolidated_metadata":{"kind":"inline","metadata":{)", copies, "}}")));
  EXPECT_EQ(list_zarr(files.path(), {}).size(), 1000U);
  SourceOptions options;
  options.dataset = "a999";
  EXPECT_EQ(files.read(options), std::vector<float>{14});
}

TEST(ZarrLimits, LargeConsolidatedMetadata_AreRefusedButNotTheArray) {
  const ZarrFiles files;
  files.write("zarr.json", group_with(std::string(kMostMetadataBytes, ' ')));
  files.write("a/zarr.json", array_with(R"("units":"K")"));
  SourceOptions options;
  options.dataset = "a";
  EXPECT_EQ(
      files.message(ErrorKind::input, options),
      "run.zarr/zarr.json: has 16777253 bytes, more than the 16777216 that metadata may have; if it is a group's, "
      "name the array in it by its own path");
  const auto source = open_source(files.path("a"), {});
  EXPECT_EQ(ZarrFiles::read_all(*source), std::vector<float>{7});
  EXPECT_EQ(source->info().units, "K");
}

TEST(ZarrLimits, MoreValuesThanALookThroughTakes_AreRefusedAndNamedArraysAreRead) {
  const ZarrFiles files;
  files.write("zarr.json", group_with(""));
  for (int i = 0; i < 6; ++i) files.write(cat("a", i, "/zarr.json"), array_with(list_of(90000)));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr: has more than 500000 JSON values in the metadata of its arrays; name a group or an array in it");
  SourceOptions options;
  options.dataset = "a5";
  EXPECT_EQ(files.read(options), std::vector<float>{7});
}

}  // namespace
}  // namespace weir::zarr_limits_test
