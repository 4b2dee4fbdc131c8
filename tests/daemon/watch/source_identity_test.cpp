#include "daemon/watch/source_identity.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/temporary_directory.h"

namespace weir::source_identity_test {
namespace {

FileIdentity identity_of(const std::string& path, const std::vector<std::string>& convert_options) {
  return identify_source(path, convert_options).value();
}

TEST(SourceIdentity, IdentityIsOfTheMetadataOnTheWayToTheDataset) {
  const TemporaryDirectory directory;
  const std::string store = directory / "run.zarr";
  const std::string head = store + "/.zgroup";
  std::filesystem::create_directories(store + "/a/rho");
  std::filesystem::create_directories(store + "/b");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(store + '/' + name) << text;
  };
  write(".zgroup", "{}");
  const auto identity = [&](const std::string& option) { return identity_of(head, {option}); };
  const auto changes = [&](const std::string& option, const std::string& name, const std::string& text) {
    const FileIdentity before = identity(option);
    EXPECT_EQ(identity(option), before);
    write(name, text);
    return !(identity(option) == before);
  };
  EXPECT_EQ(identity("--dataset=/a/rho/").bytes, 2U);
  EXPECT_TRUE(changes("--dataset=/a/rho/", "a/.zgroup", "{ }"));
  EXPECT_TRUE(changes("--dataset=/a/rho/", "a/rho/.zarray", "1234"));
  EXPECT_EQ(identity("--dataset=/a/rho/").bytes, 9U);
  EXPECT_TRUE(changes("--dataset=a/rho", "a/rho/.zattrs", "1"));
  EXPECT_TRUE(changes("--dataset=a/rho", ".zmetadata", "1"));
  EXPECT_FALSE(changes("--dataset=a/rho", "b/.zarray", "1"));
  EXPECT_FALSE(changes("--dataset=a/rho", "a/rho/0.0.0", "1"));
  EXPECT_TRUE(changes("--magnitude=a/rho,b", "b/.zarray", "12"));
}

TEST(SourceIdentity, WithoutADataset_IdentityIsOfAllGroupsAndArrays) {
  const TemporaryDirectory directory;
  const std::string store = directory / "run.zarr";
  const std::string head = store + "/zarr.json";
  for (const char* const node : {"a/rho/c/0", "b/image/0", "b/image/1", "plain"})
    std::filesystem::create_directories(store + '/' + node);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(store + '/' + name) << text;
  };
  for (const char* const node : {"", "a/", "a/rho/", "b/", "b/image/"}) write(cat(node, "zarr.json"), "{}");
  for (const char* const array : {"b/image/0", "b/image/1"}) write(cat(array, "/.zarray"), "{}");
  const auto changes = [&](const std::vector<std::string>& options, const std::string& name, const std::string& text) {
    const auto identity = [&] { return identity_of(head, options); };
    const FileIdentity before = identity();
    EXPECT_EQ(identity(), before);
    write(name, text);
    return !(identity() == before);
  };
  EXPECT_TRUE(changes({}, "a/rho/zarr.json", "1"));
  EXPECT_TRUE(changes({"--lossless"}, "b/image/1/.zarray", "1"));
  EXPECT_TRUE(changes({"--dataset=b/im*"}, "b/image/0/.zattrs", "1"));
  EXPECT_TRUE(changes({"--dataset=b/image"}, "b/image/0/.zarray", "123"));  // the finest scale
  EXPECT_FALSE(changes({"--dataset=b/image"}, "a/rho/zarr.json", "123"));
  EXPECT_FALSE(changes({}, "a/rho/c/0/zarr.json", "1"));  // among chunks
  EXPECT_FALSE(changes({}, "plain/notes", "1"));
  EXPECT_TRUE(changes({}, "plain/zarr.json", "1"));  // a new array
  std::filesystem::create_directory_symlink("..", store + "/b/again");
  EXPECT_TRUE(identify_source(head, {}));
}

/// A hierarchy whose metadata are looked at without options.
class WholeStore {
 public:
  WholeStore() { write("zarr.json", R"({"node_type": "group"})"); }

  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path(store_ + '/' + name);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  void write_files(const std::string& group, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) std::ofstream(cat(store_, '/', group, "/0.0.", i));
  }
  FileIdentity identity() const { return identity_of(store_ + "/zarr.json", {}); }
  bool notices(const std::string& name, const std::string& text) const {
    const FileIdentity before = identity();
    write(name, text);
    return !(identity() == before);
  }

 private:
  TemporaryDirectory directory_;
  std::string store_ = directory_ / "run.zarr";
};

constexpr const char* kArray = R"({"node_type": "array", "attributes": {"valid_max": NaN}})";

TEST(SourceIdentity, ArraysOfVersion3_AreNotLookedInto) {
  const WholeStore store;
  store.write("a/zarr.json", kArray);
  store.write("a/c/0/zarr.json", "{}");
  store.write_files("a", kMostListedEntries);
  store.write("b/zarr.json", R"({"node_type": "group"})");
  store.write("b/rho/zarr.json", kArray);
  EXPECT_TRUE(store.notices("a/zarr.json", cat(kArray, ' ')));
  EXPECT_FALSE(store.notices("a/c/zarr.json", "{}"));
  EXPECT_TRUE(store.notices("b/rho/zarr.json", cat(kArray, ' '))) << "the chunks of `a` are none of those listed";
}

TEST(SourceIdentity, MetadataOfVersion3ThatAreNoArrays_AreLookedInto) {
  const WholeStore store;
  const std::string consolidated = R"("consolidated_metadata": {"metadata": {"rho": {"node_type": "array"}}})";
  store.write("a/zarr.json", cat("{", consolidated, R"(, "node_type": "group"})"));
  store.write("b/zarr.json", R"({"node_ty)");  // it is still being written
  store.write("c/zarr.json",
              cat(R"({"node_type": "array", "attributes": {"long": ")", std::string(1U << 20U, 'a'), "\"}}"));
  for (const char* const group : {"a", "b", "c"}) {
    store.write(cat(group, "/rho/zarr.json"), kArray);
    EXPECT_TRUE(store.notices(cat(group, "/rho/zarr.json"), cat(kArray, ' '))) << group;
  }
}

TEST(SourceIdentity, OfADirectoryWithMoreEntriesThanAreListed_NoneIsTaken) {
  const WholeStore store;
  store.write("a/zarr.json", R"({"node_type": "group"})");
  store.write("a/rho/zarr.json", kArray);
  store.write("b/zarr.json", R"({"node_type": "group"})");
  store.write_files("b", kMostListedEntries - 3 - 2 - 2);  // besides those of the hierarchy, `a` and the other two
  store.write("b/rho/zarr.json", kArray);
  EXPECT_TRUE(store.notices("b/rho/zarr.json", cat(kArray, ' '))) << "as many as are listed";
  const std::uint64_t all = store.identity().bytes;
  store.write("b/one_more", "");
  EXPECT_EQ(store.identity().bytes, all - std::string(kArray).size() - 1);
  EXPECT_FALSE(store.notices("b/rho/zarr.json", kArray));
  EXPECT_TRUE(store.notices("b/zarr.json", R"({"node_type": "group" })"));
  EXPECT_TRUE(store.notices("a/rho/zarr.json", cat(kArray, ' ')));
}

TEST(SourceIdentity, IdentityIsOfABoundedNumberOfNodes) {
  const TemporaryDirectory directory;
  const std::string store = directory / "run.zarr";
  std::filesystem::create_directory(store);
  std::ofstream(store + "/.zgroup") << "12";
  for (std::size_t i = 0; i < kMostWatchedNodes + 10; ++i) {
    std::filesystem::create_directory(cat(store, '/', i));
    std::ofstream(cat(store, '/', i, "/.zarray")) << "1";
  }
  EXPECT_EQ(identity_of(store + "/.zgroup", {}).bytes, 2 + kMostWatchedNodes - 1);
}

}  // namespace
}  // namespace weir::source_identity_test
