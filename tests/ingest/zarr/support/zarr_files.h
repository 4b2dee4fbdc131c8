// Writes small Zarr hierarchies by hand.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/text.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir {

/// A directory run.zarr. Its files are written by their keys.
class ZarrFiles {
 public:
  std::string path(std::string_view key = {}) const {
    const std::string root = directory_ / "run.zarr";
    return key.empty() ? root : root + '/' + std::string(key);
  }
  void write(std::string_view key, std::string_view bytes) const {
    std::filesystem::create_directories(std::filesystem::path(path(key)).parent_path());
    std::ofstream(path(key), std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  template <typename T>
  void write_values(std::string_view key, const std::vector<T>& values) const {
    write(key, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }
  std::vector<float> read(const SourceOptions& options = {}) const { return read_all(*open_source(path(), options)); }

  static std::vector<float> read_all(VolumeSource& source) {
    std::vector<float> values(static_cast<std::size_t>(source.info().domain().voxels()));
    source.read(source.info().domain(), values);
    return values;
  }
  /// Returns the error message of opening the store and reading all of it, which must fail.
  std::string message(ErrorKind kind, const SourceOptions& options = {}) const {
    const std::string text = message_of_error(kind, [&] { read(options); });
    return text.starts_with(path()) ? "run.zarr" + text.substr(path().size()) : text;
  }

 private:
  TemporaryDirectory directory_;
};

/// Returns the zarr.json of an array of `shape` in chunks of `chunk`: uint8 and uncompressed unless `codecs` and
/// `type` say otherwise.
inline std::string zarr_json(std::string_view shape, std::string_view chunk,
                             std::string_view codecs = R"([{"name":"bytes"}])", std::string_view type = "uint8",
                             std::string_view fill = "7", std::string_view more = "") {
  return cat(R"({"zarr_format":3,"node_type":"array","shape":)", shape, R"(,"data_type":")", type,
             R"(","chunk_grid":{"name":"regular","configuration":{"chunk_shape":)", chunk,
             R"(}},"chunk_key_encoding":{"name":"default"},"codecs":)", codecs, R"(,"fill_value":)", fill, more, "}");
}

/// Returns the .zarray of an array in the same way as zarr_json().
inline std::string zarray(std::string_view shape, std::string_view chunk, std::string_view type = "|u1",
                          std::string_view fill = "7", std::string_view more = R"("compressor":null,"filters":null)") {
  return cat(R"({"zarr_format":2,"order":"C","shape":)", shape, R"(,"chunks":)", chunk, R"(,"dtype":")", type,
             R"(","fill_value":)", fill, ",", more, "}");
}

}  // namespace weir
