// Writes the part of a .vdb file of one float grid that precedes the tree: magic, versions, metadata, offsets of its
// parts, transform. ingest/vdb/vdb_header.h reads it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "format/io/digest.h"

namespace weir {

/// Metadata names and values, in OpenVDB's types string, double, int64, bool and vec3i.
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

  Digest content;                  ///< the file's UUID is made of this digest, so that equal files have equal UUIDs
  std::uint64_t leaves_begin = 0;  ///< offset in the file of the leaves' values
  std::uint64_t end = 0;           ///< bytes of the file
};

/// Returns the bytes of the head, which the tree follows at once. Their number does not depend on `content`, the
/// offsets, or metadata values that are not strings.
std::string vdb_head_bytes(const VdbHead& head);

/// Returns why OpenVDB cannot read a grid of this transform; empty if it can.
std::string vdb_transform_obstacle(const std::array<double, 9>& matrix, const std::array<double, 3>& translation);

}  // namespace weir
