#include "bindings/mpi/pushed_boxes.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "bindings/mpi/mpi_file_system.h"
#include "compressor/conversion_control.h"
#include "compressor/push/spool_source.h"
#include "compressor/resume/journal.h"
#include "format/base/box_set.h"
#include "format/base/text.h"
#include "ingest/plan/strided_copy.h"
#include "ingest/source/extent.h"
#include "ingest/values/array_source.h"

namespace weir {
namespace {

constexpr std::uint64_t kGatheredBytes = std::uint64_t{4} << 20U;  // bytes gathered before they are written

std::string box_text(const Box& box, const Index3& origin) {
  const Index3 lo = box.lo - origin;
  const Index3 hi = box.hi - origin;
  return cat(lo.x, ':', hi.x, ',', lo.y, ':', hi.y, ',', lo.z, ':', hi.z);
}

// Calls visit(part) for parts of `box`. Parts end at borders of leaves or at the end of `box`, and have about
// kGatheredBytes or one row of leaves each.
template <typename Visit>
void for_each_piece(const Box& box, std::size_t value_bytes, const Visit& visit) {
  const auto leaf_end = [](std::int64_t at) { return (floor_div(at, kLeafDim) + 1) * kLeafDim; };
  const auto row_bytes = static_cast<std::uint64_t>(box.extent().x * kLeafDim * kLeafDim) * value_bytes;
  const auto rows = static_cast<std::int64_t>(std::max<std::uint64_t>(1, kGatheredBytes / row_bytes));
  for (std::int64_t z = box.lo.z; z < box.hi.z;) {
    const std::int64_t z_end = std::min(box.hi.z, leaf_end(z));
    for (std::int64_t y = box.lo.y; y < box.hi.y;) {
      const std::int64_t y_end = std::min(box.hi.y, leaf_end(y) + (rows - 1) * kLeafDim);
      visit(Box{{box.lo.x, y, z}, {box.hi.x, y_end, z_end}});
      y = y_end;
    }
    z = z_end;
  }
}

// Guards a scope that either all ranks or none leave by a failure. If one rank fails alone, the others would wait for
// it inside the scope. The destructor meets them with a call of the team, which then ends all ranks.
class FailingTogether {
 public:
  explicit FailingTogether(Team& team) : team_(team) {}
  ~FailingTogether() {
    if (std::uncaught_exceptions() == before_) return;
    try {
      team_.run([] {});
    } catch (const std::exception&) {
      // The earlier failure is the one to report.
    }
  }
  FailingTogether(const FailingTogether&) = delete;
  FailingTogether& operator=(const FailingTogether&) = delete;

 private:
  Team& team_;
  const int before_ = std::uncaught_exceptions();
};

}  // namespace

PushedBoxes::PushedBoxes(SourceInfo info, const ConversionOptions& options, const ConversionControl& control,
                         MpiTeam& team)
    : team_(team),
      info_(as_pushed(std::move(info))),
      options_(options),
      control_(control),
      local_(make_posix_file_system()),
      shared_(make_mpi_file_system(team, *local_)),
      output_(*shared_, options.output, options.overwrite),
      work_(*shared_, options.output, options.work_dir),
      values_(work_.spill()),
      states_(work_.spill()),
      spool_(values_, states_, make_lattice(info_.domain(), kLeafDim), info_.type) {
  bool removed = false;
  team_.lead([&] {
    removed = remove_leftovers(*local_, options_.output);
    const std::string hidden = hidden_directory_of(options_.output);
    if (work_.path() != hidden) remove_if_empty(*local_, hidden);
  });
  team_.follow(removed);
  if (removed && control_.notice) control_.notice(leftovers_notice(options_.output));
}

void PushedBoxes::box(const Box& box, const void* data, const std::array<std::int64_t, 3>& stride) {
  if (failure_) throw Error(*failure_);
  const Box whole{{0, 0, 0}, info_.extent};
  if (data == nullptr) throw Error(ErrorKind::usage, cat(info_.path, ": the box's data is a null pointer"));
  if (box.empty() || !whole.contains(box)) {
    throw Error(ErrorKind::usage, cat(info_.path, ": a box of voxels ", box_text(box, {}), " is not in the volume of ",
                                      extent_text(info_.extent)));
  }
  check_strides(info_.path, box.extent(), stride);
  const Index3 origin = info_.index_origin;
  const StridedVoxels from{
      {box.lo + origin, box.hi + origin}, static_cast<const std::byte*>(data), stride, scalar_bytes(info_.type)};
  std::vector<std::byte> piece;
  try {
    check_cancel(control_);
    for_each_piece(from.box, from.value_bytes, [&](const Box& part) {
      piece.resize(static_cast<std::size_t>(part.voxels()) * from.value_bytes);
      copy_voxels(from, part, piece.data());
      spool_.write(part, piece);
    });
    given_.push_back(from.box);
  } catch (const Error& error) {
    failure_ = error;
    throw;
  } catch (const std::exception& error) {
    failure_ = Error(ErrorKind::internal, error.what());
    throw;
  }
}

// Checks that each voxel was given exactly once.
void PushedBoxes::check_complete() {
  std::vector<Box> all = given_;
  team_.concatenate(all);
  const Coverage found = coverage_of(info_.domain(), all);
  if (found.repeated) {
    throw Error(ErrorKind::usage,
                cat(info_.path, ": voxels of the box ", box_text(all[*found.repeated], info_.index_origin),
                    " were given twice; give each voxel once"));
  }
  if (found.missing.empty()) return;
  std::int64_t voxels = 0;
  for (const Box& box : found.missing) voxels += box.voxels();
  throw Error(ErrorKind::usage,
              cat(info_.path, ": ", voxels, voxels == 1 ? " voxel is" : " voxels are", " missing, those of ",
                  box_text(found.missing.front(), info_.index_origin), " first"));
}

Sidecar PushedBoxes::end() {
  const FailingTogether together(team_);
  team_.run([&] {
    if (failure_) throw Error(*failure_);
  });
  check_complete();
  team_.publish(*values_);
  team_.publish(*states_);
  const std::unique_ptr<VolumeSource> source = open_spool(spool_, info_);
  try {
    return convert_into(output_, work_, *source, options_, control_, team_);
  } catch (const Error& error) {
    failure_ = error;
    throw;
  }
}

}  // namespace weir
