// What the steps of a series have in common, kept up to date while files come and are replaced. One thread at a time.
#pragma once

#include <map>
#include <string>

#include "tools/options/volume_series.h"

namespace weir {

class SeriesHeads {
 public:
  /// Adds the head of the file that has the path now, unless it has been read: of a file that took another's place, or
  /// could not be read before, it is read again. Whether it has been read by now. What a file that is gone has added
  /// stays.
  bool look_at(const std::string& path);
  const SeriesSummary& summary() const { return summary_; }

 private:
  SeriesSummary summary_;
  std::map<std::string, std::string> read_;  // file_identity by path
};

}  // namespace weir
