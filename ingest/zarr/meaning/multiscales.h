// The multiscales metadata of OME-Zarr (versions 0.1 to 0.5): the arrays that are the levels of an image, and the
// places of their voxels.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/zarr/meaning/zarr_nodes.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

struct ScaleAxis {
  std::string name;  ///< "z"; empty if the metadata do not name axes
  std::string type;  ///< "space", "time", "channel"; empty if the metadata do not say it
  std::string unit;  ///< "micrometer"; empty if the metadata do not say it
};

/// One level of an image.
struct ScaleLevel {
  std::string path;                 ///< path of the level's array within the image's group, without slashes at its ends
  std::vector<double> scale;        ///< from index to position, along each axis; empty: 1
  std::vector<double> translation;  ///< position of the centre of element 0; empty: 0
  /// False if a transformation is not identity, scale or translation by numbers, or if two of them have different
  /// numbers of values; `scale` and `translation` are empty then.
  bool placed = true;
};

struct Multiscale {
  std::vector<ScaleAxis> axes;
  std::vector<ScaleLevel> levels;  ///< the finest first
  std::string document = {};       ///< key of the document that describes the image, ".zattrs"
};

/// Returns the images that the attributes of a group describe, with the transformations applied to all levels.
/// Entries that are not images are left out.
std::vector<Multiscale> multiscales_in(const nlohmann::json& attributes);

/// A level of an image, and the image.
struct FoundLevel {
  Multiscale image;
  std::size_t level = 0;
};

/// Finds the image level that an array is. Reads the metadata of each group once and keeps them. For one thread at a
/// time.
class LevelFinder {
 public:
  /// `store` must outlive this object.
  explicit LevelFinder(ZarrStore& store) : store_(store) {}

  /// Returns the level that the array at `key` is, as a group around it describes; nullopt if no group does.
  std::optional<FoundLevel> find(const std::string& key);

 private:
  const std::vector<Multiscale>& images_of(const std::string& group);

  ZarrStore& store_;
  std::map<std::string, std::vector<Multiscale>> images_;  ///< by the group's key
};

}  // namespace weir
