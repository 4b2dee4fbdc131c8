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

/// A group or array, as the metadata at its key describe it.
struct ZarrNode {
  std::string key;
  std::string document;       ///< key of the document that describes it
  bool array = false;         ///< false: a group
  int version = 3;            ///< 2 or 3
  nlohmann::json metadata;    ///< of zarr.json without attributes, or of .zarray; empty for a group of version 2
  nlohmann::json attributes;  ///< the user attributes
};

/// Returns the node at `key`; nullopt if there is no metadata. Throws Error(input) if the metadata are damaged.
std::optional<ZarrNode> zarr_node(ZarrStore& store, const std::string& key);

/// Returns the attribute _Unsigned; empty if there is none. NetCDF writes "true" if signed integers are meant as
/// unsigned, and "false" if unsigned integers are meant as signed.
std::string unsigned_text(const nlohmann::json& attributes);

/// Returns the array that `node`, an array, describes, with the type that its attribute _Unsigned means. Throws the
/// errors of parse_zarr_v2 and parse_zarr_v3.
ZarrArray zarr_array(const ZarrStore& store, const ZarrNode& node);

/// Returns all arrays in the order of their keys; only the root if that is an array. Searches groups, not arrays.
/// Throws Error(input) if there are more than kMostZarrNodes nodes or kMostZarrDepth nested groups, or if the
/// metadata have more than kMostWalkedBytes bytes or kMostWalkedValues values.
std::vector<ZarrNode> zarr_arrays(ZarrStore& store);

inline constexpr std::size_t kMostZarrNodes = 10000;
inline constexpr std::size_t kMostZarrDepth = 32;
inline constexpr std::uint64_t kMostWalkedBytes = std::uint64_t{32} << 20U;
/// The most JSON values in the metadata of all arrays. An array has 20 to 50.
inline constexpr std::size_t kMostWalkedValues = 500000;

}  // namespace weir
