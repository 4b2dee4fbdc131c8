// Makes .vti files by hand, byte by byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/packed.h"

namespace weir {

inline std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kAlphabet[bits >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

/// How values are stored, and the attributes of VTKFile that say so.
struct VtiStorage {
  bool big_endian = false;
  bool wide = false;           ///< header_type UInt64
  std::size_t zlib_block = 0;  ///< unpacked bytes per block; 0: uncompressed

  std::string attributes() const {
    return std::string(" byte_order=\"") + (big_endian ? "BigEndian" : "LittleEndian") + "\"" +
           (wide ? " header_type=\"UInt64\"" : "") + (zlib_block > 0 ? " compressor=\"vtkZLibDataCompressor\"" : "");
  }
  std::vector<std::byte> words(const std::vector<std::uint64_t>& sizes) const {
    if (wide) return stored(sizes, big_endian);
    return stored(std::vector<std::uint32_t>(sizes.begin(), sizes.end()), big_endian);
  }
};

/// The sizes that precede the values, and the values as they are stored.
struct VtiData {
  std::vector<std::byte> sizes;
  std::vector<std::byte> values;

  std::vector<std::byte> raw() const {
    auto all = sizes;
    all.insert(all.end(), values.begin(), values.end());
    return all;
  }
  /// Returns the base64 text that VTK writes. It encodes sizes and compressed values apart, uncompressed ones together.
  std::string text(const VtiStorage& storage) const {
    return storage.zlib_block > 0 ? base64(sizes) + base64(values) : base64(raw());
  }
};

inline VtiData vti_data(std::span<const std::byte> values, const VtiStorage& storage) {
  if (storage.zlib_block == 0) return {storage.words({values.size()}), {values.begin(), values.end()}};
  const std::size_t blocks = (values.size() + storage.zlib_block - 1) / storage.zlib_block;
  std::vector<std::uint64_t> sizes{blocks, storage.zlib_block, values.size() % storage.zlib_block};
  VtiData data;
  for (std::size_t at = 0; at < values.size(); at += storage.zlib_block) {
    const auto packed = deflated(values.subspan(at, std::min(storage.zlib_block, values.size() - at)), Wrapper::zlib);
    sizes.push_back(packed.size());
    data.values.insert(data.values.end(), packed.begin(), packed.end());
  }
  data.sizes = storage.words(sizes);
  return data;
}

/// Returns a file of 4 x 3 x 2 points around `arrays`, the contents of its Piece.
inline std::string vti(const VtiStorage& storage, const std::string& arrays, const std::string& appended = "",
                       const std::string& placement = "") {
  return "<?xml version=\"1.0\"?>\n<!-- by hand: a > b -->\n<VTKFile type=\"ImageData\" version=\"1.0\"" +
         storage.attributes() + ">\n  <ImageData WholeExtent=\"0 3 0 2 0 1\"" + placement +
         ">\n    <Piece Extent=\"0 3 0 2 0 1\">\n" + arrays + "    </Piece>\n  </ImageData>\n" + appended +
         "</VTKFile>\n";
}

inline std::string point_array(const std::string& attributes, const std::string& text = "") {
  return "<PointData><DataArray " + attributes + ">" + text + "</DataArray></PointData>\n";
}

inline std::string chars(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace weir
