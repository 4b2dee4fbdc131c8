// The groups and arrays of a Zarr hierarchy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// What the metadata at a key say.
struct ZarrNode {
  std::string key;
  std::string document;       ///< key of the document that describes it
  bool array = false;         ///< else a group
  int version = 3;            ///< 2 or 3
  nlohmann::json metadata;    ///< of zarr.json, without attributes, or .zarray; of a group of version 2 empty
  nlohmann::json attributes;  ///< of the user
};

/// The node at `key`; nullopt where there is no metadata. Throws Error(input) where they are damaged.
std::optional<ZarrNode> zarr_node(ZarrStore& store, const std::string& key);

/// Of the attribute _Unsigned, by which NetCDF says that signed integers are meant as unsigned ones ("true"), or
/// unsigned ones as signed ("false"); empty where there is none.
std::string unsigned_text(const nlohmann::json& attributes);

/// The array that `node`, which is one, describes, of the type that is meant. Throws what parse_zarr_v2 and
/// parse_zarr_v3 throw.
ZarrArray zarr_array(const ZarrStore& store, const ZarrNode& node);

/// All arrays in the order of their keys; the root alone where that is one. Groups are looked into, arrays are not.
/// Throws Error(input) where there are more than kMostZarrNodes nodes or kMostZarrDepth groups in each other, or their
/// metadata have more than kMostWalkedBytes or kMostWalkedValues.
std::vector<ZarrNode> zarr_arrays(ZarrStore& store);

inline constexpr std::size_t kMostZarrNodes = 10000;
inline constexpr std::size_t kMostZarrDepth = 32;
inline constexpr std::uint64_t kMostWalkedBytes = std::uint64_t{32} << 20U;
/// An array has 20 to 50.
inline constexpr std::size_t kMostWalkedValues = 500000;

}  // namespace weir
