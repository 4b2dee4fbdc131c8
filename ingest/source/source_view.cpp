#include "ingest/source/source_view.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"
#include "ingest/source/forwarded_source.h"

namespace weir {
namespace {

/// A source at another place in the world.
class PlacedSource final : public ForwardedSource {
 public:
  // `info` is the source's info with another place.
  PlacedSource(std::unique_ptr<VolumeSource> source, SourceInfo info)
      : ForwardedSource(std::move(source)), info_(std::move(info)) {}

  const SourceInfo& info() const override { return info_; }

 private:
  SourceInfo info_;
};

class CroppedSource final : public ForwardedSource {
 public:
  // `info` is the source's info with a smaller domain, inside the source's.
  CroppedSource(std::unique_ptr<VolumeSource> source, SourceInfo info)
      : ForwardedSource(std::move(source)), info_(std::move(info)) {}

  const SourceInfo& info() const override { return info_; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    check(box);
    return source().read(box, values);
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    check(box);
    return source().read_alone(box, values);
  }
  std::vector<Box> voxels_with_values(const Box& box) const override {
    check(box);
    return source().voxels_with_values(box);
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    check(box);
    return source().repeated_parts(box);
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    check(part.box);
    return source().read_repeated(part, values);
  }
  // These cover whole volumes and whole leaves, which the region's border cuts.
  ResidentVolume* resident() override { return nullptr; }
  const CellPlaces* places() const override { return nullptr; }
  const HeldLeaves* held(const Box& /*box*/) const override { return nullptr; }

 private:
  void check(const Box& box) const {
    if (!box.empty() && info_.domain().contains(box)) return;
    throw Error(ErrorKind::internal,
                cat(info_.path, ": read of box ", box_text(box), " outside the region ", box_text(info_.domain())));
  }

  SourceInfo info_;
};

// Returns the error for an invalid spacing or origin (`key`) of `info`, given by the user or found in the file by
// `from`.
Error unusable(const SourceInfo& info, bool given, std::string_view key, double value, std::string_view rule,
               const std::string& from) {
  if (given) return {ErrorKind::usage, compose(info.path, ": ", option(key), " has ", value, "; each must be ", rule)};
  const std::string where = from.empty() || info.dataset.empty() ? info.path : cat(info.path, ": ", info.dataset);
  const std::string found = from.empty() ? cat(value) : cat(value, " (", from, ')');
  return {ErrorKind::input,
          compose(where, ": its ", key, " has ", found, ", which is not ", rule, "; give ", option(key, "x,y,z"))};
}

}  // namespace

std::string too_far_away(const Box& domain, const std::array<double, 3>& spacing, const std::array<double, 3>& origin) {
  const std::array<std::int64_t, 3> begin{domain.lo.x, domain.lo.y, domain.lo.z};
  const std::array<std::int64_t, 3> end{domain.hi.x, domain.hi.y, domain.hi.z};
  for (std::size_t a = 0; a < 3; ++a) {
    for (const std::int64_t at : {begin[a], end[a]}) {
      const double place = origin[a] + static_cast<double>(at) * spacing[a];
      if (std::fabs(place) <= static_cast<double>(std::numeric_limits<float>::max())) continue;
      return cat("reaches ", place, " along ", "xyz"[a], " with ", end[a] - begin[a], " voxels ", spacing[a],
                 " apart, and float32 does not hold that");
    }
  }
  return "";
}

std::unique_ptr<VolumeSource> crop_to(std::unique_ptr<VolumeSource> source, const VolumeRegion& region) {
  const SourceInfo& info = source->info();
  const Box box = region.in(info.domain());
  if (box.empty() && region.ghost != std::array<std::int64_t, 3>{}) {
    throw Error(
        ErrorKind::usage,
        compose(info.path, ": ", option("ghost", cat(region.ghost[0], ',', region.ghost[1], ',', region.ghost[2])),
                " leaves no voxel of ", info.extent.x, " x ", info.extent.y, " x ", info.extent.z,
                "; it is taken from both ends of each axis, give fewer layers"));
  }
  return crop_source(std::move(source), box);
}

std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region) {
  const SourceInfo& info = source->info();
  if (region.empty()) {
    throw Error(ErrorKind::usage, compose(info.path, ": ", option("roi", box_text(region)),
                                          " holds no voxel; each axis is "
                                          "FROM:TO with FROM below TO"));
  }
  if (!info.domain().contains(region)) {
    throw Error(ErrorKind::usage, compose(info.path, ": ", option("roi", box_text(region)),
                                          " reaches outside the volume ", box_text(info.domain()), "; keep it within"));
  }
  SourceInfo cropped = info;
  cropped.extent = region.extent();
  cropped.index_origin = region.lo;
  return std::make_unique<CroppedSource>(std::move(source), std::move(cropped));
}

namespace {

void check_given_place(const SourceInfo& placed, const SourceOptions& options) {
  for (std::size_t a = 0; a < placed.spacing.size(); ++a) {
    const double s = placed.spacing.at(a);
    const auto refuse = [&](std::string_view rule) {
      return unusable(placed, options.spacing.has_value(), "spacing", s, rule, placed.spacing_from.at(a));
    };
    if (!(s > 0.0) || !std::isfinite(s)) throw refuse("finite and above 0");
    if (s < kLeastSpacing || s > kMostSpacing) throw refuse("within 1e-37 and 1e+37");
  }
  for (std::size_t a = 0; a < placed.origin.size(); ++a) {
    const double o = placed.origin.at(a);
    const auto refuse = [&](std::string_view rule) {
      return unusable(placed, options.origin.has_value(), "origin", o, rule, placed.origin_from.at(a));
    };
    if (!std::isfinite(o)) throw refuse("finite");
    if (std::fabs(o) > kMostOrigin) throw refuse("within -1e+37 and 1e+37");
  }
}

// Removes what a given spacing makes obsolete. A spacing replaces coordinates in space. It does not replace a time:
// coordinates of a time ("... since ...") stay, but if the axis has a spacing only, its time units are removed.
void leave_out_positions(AxisDetails& axis) {
  const bool counts_time = axis.units.find(" since ") != std::string::npos;
  if (!counts_time) {
    axis.coordinates.clear();
  } else if (axis.coordinates.empty()) {
    axis.units.clear();
  }
}

}  // namespace

std::unique_ptr<VolumeSource> place_source(std::unique_ptr<VolumeSource> source, const SourceOptions& options) {
  SourceInfo placed = source->info();
  placed.spacing = options.spacing.value_or(placed.spacing);
  placed.origin = options.origin.value_or(placed.origin);
  check_given_place(placed, options);
  if (const std::string why = too_far_away(placed.domain(), placed.spacing, placed.origin); !why.empty()) {
    throw Error(options.spacing ? ErrorKind::usage : ErrorKind::input,
                compose(placed.path, ": ", why, "; give a smaller ", option("spacing")));
  }
  if (!options.spacing && !options.origin) return source;
  if (options.spacing) {  // notes on the file's own spacing no longer apply
    for (AxisDetails& axis : placed.details.axes) {
      if (!axis.reversed) axis.note.clear();
      leave_out_positions(axis);
    }
    placed.details.units_note.clear();
  }
  return std::make_unique<PlacedSource>(std::move(source), std::move(placed));
}

}  // namespace weir
