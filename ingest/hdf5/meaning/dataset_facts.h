// All that is known of a dataset without reading its values: what listing and
// opening share.
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
  ComponentAxis components;     ///< the last of them, where it holds components
  std::string type_text;
  std::optional<StoredType> type;  ///< of those that can be converted
  std::optional<Storage> storage;  ///< of a dataset
  std::optional<double> constant;  ///< of an openPMD constant component: its value
  ValueMeaning meaning;            ///< where there is a type
  std::string place_note;          ///< that the spacing is that of an attribute of no one meaning; else empty
  std::string obstacle;            ///< why it cannot be converted; empty where it can
  bool marks = false;              ///< an array of VTK's that is no field, and a volume only where it is named
  bool over_time = false;          ///< that is all: one of the three axes is a time, and no length

  /// "contiguous", "chunked 64 x 64 x 64, gzip", "constant 0".
  std::string layout_text() const;
};

/// Looks at a dataset or openPMD constant. The caller holds Hdf5Lock.
DatasetFacts dataset_facts(hid_t file, const Hdf5Object& object);

}  // namespace weir
