// Tests a Zarr array with a chunk that was never written. The sidecar of its volume records this.
#include "tests/users/user_script.h"

namespace weir::unstored_chunks_test {
namespace {

class UnstoredChunks : public UserScript {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(directory_ / "a.zarr");
    write_file(directory_ / "a.zarr/.zarray",
               R"({"zarr_format": 2, "shape": [8, 8, 16], "chunks": [8, 8, 8], "dtype": "|u1", "order": "C",
                   "fill_value": 7, "filters": null, "compressor": null})");
    write_file(directory_ / "a.zarr/0.0.0", std::string(512, '\3'));
  }

  nlohmann::json source_of(const std::string& volume) const {
    return nlohmann::json::parse(read_file(directory_ / (volume + ".json")))["source"];
  }
};

TEST_F(UnstoredChunks, AreInTheSidecar) {
  const CommandResult made = weir({"convert", "a.zarr", "--lossless", "-o", "a.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(source_of("a.nvdb")["unstored_chunks"], "1 of its 2 chunks is not stored and reads as its fill value, 7");
}

TEST_F(UnstoredChunks, ThatAreNoneHaveNoKey) {
  write_file(directory_ / "a.zarr/0.0.1", std::string(512, '\4'));
  const CommandResult made = weir({"convert", "a.zarr", "--lossless", "-o", "a.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_FALSE(source_of("a.nvdb").contains("unstored_chunks"));
}

}  // namespace
}  // namespace weir::unstored_chunks_test
