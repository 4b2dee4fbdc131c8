#include "ingest/hdf5/meaning/volume_slice.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// "Time in 0..3, level in 0..13"
std::string ranges_text(std::span<const AxisPlace> leading) {
  std::string text;
  for (std::size_t i = 0; i < leading.size(); ++i) {
    const std::string name = leading[i].label.empty() ? cat("axis ", i) : leading[i].label;
    text += cat(i == 0 ? "" : ", ", name, " in 0..", leading[i].extent - 1);
  }
  return text;
}

}  // namespace

std::size_t leading_axes(std::span<const AxisPlace> axes) {
  if (axes.size() <= kVolumeRank) return 0;
  const auto leading = axes.first(axes.size() - kVolumeRank);
  return std::all_of(leading.begin(), leading.end(), [](const AxisPlace& a) { return a.extent == 1; }) ? 0
                                                                                                       : leading.size();
}

VolumeSlice volume_slice(std::span<const AxisPlace> axes, const std::vector<std::int64_t>& index,
                         const std::string& where) {
  const auto leading = axes.first(axes.size() - kVolumeRank);
  const auto refuse = [&](const Message& found) {
    const Message remedy = leading.empty()
                               ? compose("leave ", option("index"), " out")
                               : compose("give ", option("index"), " with ", leading.size(),
                                         leading.size() == 1 ? " position: " : " positions: ", ranges_text(leading));
    return Error(ErrorKind::usage, compose(where, ": its axes are ", axes_text(axes), found, "; ", remedy));
  };
  VolumeSlice slice;
  slice.index = index.empty() && leading_axes(axes) == 0 ? std::vector<std::int64_t>(leading.size(), 0) : index;
  if (slice.index.empty() && !leading.empty()) throw refuse(", and a volume has three");
  if (slice.index.size() != leading.size()) {
    throw refuse(
        compose(", and ", option("index"), " has ", index.size(), index.size() == 1 ? " position" : " positions"));
  }
  for (std::size_t i = 0; i < leading.size(); ++i) {
    if (slice.index[i] < 0 || slice.index[i] >= leading[i].extent) {
      throw refuse(compose(", and ", option("index"), " has ", slice.index[i]));
    }
  }
  const auto last = axes.last(kVolumeRank);
  slice.extent = {last[2].extent, last[1].extent, last[0].extent};
  for (std::size_t i = 0; i < kVolumeRank; ++i) {
    const AxisPlace& axis = last[kVolumeRank - 1 - i];
    slice.labels[i] = axis.label;
    slice.spacing[i] = axis.spacing.value_or(1.0);
    slice.origin[i] = axis.origin.value_or(0.0);
  }
  return slice;
}

}  // namespace weir
