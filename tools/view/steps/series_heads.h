// The common values of the steps of a series, kept up to date while files are added and replaced. One thread at a
// time.
#pragma once

#include <map>
#include <string>

#include "tools/options/volume_series.h"

namespace weir {

class SeriesHeads {
 public:
  /// Adds the head of the file that the path names now, unless it was already read. A file that replaced another, or
  /// could not be read before, is read again. Returns whether the head has been read. Values that a vanished file
  /// added stay.
  bool look_at(const std::string& path);
  const SeriesSummary& summary() const { return summary_; }

 private:
  SeriesSummary summary_;
  std::map<std::string, std::string> read_;  // file_identity() of each file read, by path
};

}  // namespace weir
