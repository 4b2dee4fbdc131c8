// What an input file holds, for `weir inspect`: its datasets or grids and the
// command that converts each.
#pragma once

#include <string>
#include <vector>

#include "ingest/source_registry.h"

namespace weir {

struct InputListing {
  std::string path;
  std::string format;
  bool container = false;  ///< its datasets are chosen by --dataset
  std::vector<DatasetInfo> datasets;
};

/// Lists `path`; reads no values. Throws what open_source throws of the file itself.
InputListing list_input(const std::string& path, const SourceOptions& options);

/// "weir convert PATH --dataset NAME --index 0,0", quoted for a shell. The index names the first volume of
/// the leading axes.
std::string convert_command(const InputListing& listing, const DatasetInfo& dataset);

/// On stdout: for people, or as one JSON object.
void print_listing(const InputListing& listing, bool json);

}  // namespace weir
