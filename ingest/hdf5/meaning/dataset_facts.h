// All facts about a dataset that need no reading of its values. Listing and opening share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ingest/axes/component_axis.h"
#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/hdf5/file/hdf5_type.h"
#include "ingest/hdf5/meaning/axis_places.h"
#include "ingest/hdf5/meaning/value_meaning.h"
#include "ingest/hdf5/storage/storage.h"

namespace weir {

struct DatasetFacts {
  std::vector<AxisPlace> axes;  ///< slowest first
  ComponentAxis components;     ///< the last axis, if it holds components
  std::string type_text;
  std::optional<StoredType> type;  ///< set if weir can convert the type
  std::optional<Storage> storage;  ///< of a dataset
  std::optional<double> constant;  ///< of an openPMD constant component: its value
  ValueMeaning meaning;            ///< set if there is a type
  std::string place_note;          ///< says that the spacing comes from an ambiguous attribute; otherwise empty
  std::string obstacle;            ///< why the dataset cannot be converted; empty if it can
  bool marks = false;              ///< a VTK array that is no field: it is converted only if the user names it
  bool over_time = false;          ///< the only obstacle is that one of the three axes is a time and no length

  /// Returns "contiguous", "chunked 64 x 64 x 64, gzip", "constant 0".
  std::string layout_text() const;
};

/// Looks at a dataset or openPMD constant. The caller holds Hdf5Lock.
DatasetFacts dataset_facts(hid_t file, const Hdf5Object& object);

}  // namespace weir
