// What an input file holds, for `weir inspect`: its datasets or grids and the
// command that converts each.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/source_registry.h"

namespace weir {

struct InputListing {
  std::string path;
  std::string format;
  bool container = false;  ///< its datasets are chosen by --dataset
  std::vector<DatasetInfo> datasets;
  std::string words{};  ///< input options that the commands take besides their own, a space before each
};

/// Lists `path`, with options.stack as one volume; reads no values. Throws what open_source throws of the file itself,
/// and of options that are not for its format, but for the dataset.
InputListing list_input(const std::string& path, const SourceOptions& options);

/// Leaves the datasets that `dataset` names, with or without the slash before it, or as a pattern. Throws Error(usage)
/// where there is none.
void keep_named(InputListing& listing, const std::string& dataset);

/// On stdout, for people.
void print_text(const InputListing& listing);
nlohmann::ordered_json to_json(const InputListing& listing);

}  // namespace weir
