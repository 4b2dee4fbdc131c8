// What an input file holds, for `weir inspect`: its datasets or grids, and the command that converts each.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/source_registry.h"

namespace weir {

struct InputListing {
  std::string path;
  std::string format;
  bool container = false;  ///< --dataset chooses one of its datasets
  std::vector<DatasetInfo> datasets;
  std::string words{};  ///< input options that are appended to each command, each with a space before it
};

/// Lists `path`, or with options.stack one volume; reads no values. Throws what open_source throws for the file itself
/// and for options that its format does not take; the dataset is not checked here.
InputListing list_input(const std::string& path, const SourceOptions& options);

/// Keeps only the datasets that `dataset` names, with or without the leading slash, or as a pattern. Throws
/// Error(usage) if there is none.
void keep_named(InputListing& listing, const std::string& dataset);

/// Prints the listing on stdout, for people.
void print_text(const InputListing& listing);
nlohmann::ordered_json to_json(const InputListing& listing);

}  // namespace weir
