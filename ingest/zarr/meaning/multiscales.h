// What OME-Zarr (versions 0.1 to 0.5) says of an image at several scales: which arrays are its levels, and where their
// voxels lie.
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
  std::string name;  ///< "z"; empty where the metadata do not name axes
  std::string type;  ///< "space", "time", "channel"; empty where they do not say it
  std::string unit;  ///< "micrometer"; else empty
};

/// One level of an image.
struct ScaleLevel {
  std::string path;                 ///< of its array, from the image's group, without slashes at its ends
  std::vector<double> scale;        ///< from an index to a position, along each axis; empty: 1
  std::vector<double> translation;  ///< of the centre of element 0; empty: 0
  bool placed = true;  ///< false where a transformation is none of scale and translation by numbers, as many in each;
                       ///< both are empty then
};

struct Multiscale {
  std::vector<ScaleAxis> axes;
  std::vector<ScaleLevel> levels;  ///< the finest first
  std::string document = {};       ///< key of the document that says it, ".zattrs"
};

/// The images that the attributes of a group describe, transformations of all levels applied. What is no such list is
/// left out.
std::vector<Multiscale> multiscales_in(const nlohmann::json& attributes);

/// A level, and the image it is one of.
struct FoundLevel {
  Multiscale image;
  std::size_t level = 0;
};

/// Finds the images that arrays are levels of; keeps what the groups say, each of which is read once. One thread at a
/// time.
class LevelFinder {
 public:
  /// `store` outlives it.
  explicit LevelFinder(ZarrStore& store) : store_(store) {}

  /// That the array at `key` is: a group around it describes it. nullopt where none does.
  std::optional<FoundLevel> find(const std::string& key);

 private:
  const std::vector<Multiscale>& images_of(const std::string& group);

  ZarrStore& store_;
  std::map<std::string, std::vector<Multiscale>> images_;  ///< by the group's key
};

}  // namespace weir
