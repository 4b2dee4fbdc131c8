// What a .vdb file of one float grid has before the grid's tree: magic, versions,
// metadata, the places of its parts, transform. Counterpart of
// ingest/vdb/vdb_header.h, which reads it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "format/io/digest.h"

namespace weir {

/// Names and values in OpenVDB's types string, double, int64, bool and vec3i.
using VdbMetadata =
    std::map<std::string, std::variant<std::string, double, std::int64_t, bool, std::array<std::int32_t, 3>>>;

struct VdbHead {
  std::string creator;  ///< metadata of the file
  std::string name;     ///< of the grid
  bool half = false;
  std::uint32_t compression = 0;   ///< kVdbZip, kVdbActiveMask, kVdbBlosc
  VdbMetadata metadata;            ///< of the grid
  std::array<double, 9> matrix{};  ///< row-major: world = matrix * index + translation
  std::array<double, 3> translation{};

  Digest content;                  ///< the file's UUID is made of it, so that equal files have equal ones
  std::uint64_t leaves_begin = 0;  ///< offset in the file of the leaves' values
  std::uint64_t end = 0;           ///< bytes of the file
};

/// The bytes, which the tree follows at once. Their number does not depend on content, offsets, or the values of
/// metadata that are no strings.
std::string vdb_head_bytes(const VdbHead& head);

/// Why no OpenVDB can read a grid of this transform; empty where it can.
std::string vdb_transform_obstacle(const std::array<double, 9>& matrix, const std::array<double, 3>& translation);

}  // namespace weir
