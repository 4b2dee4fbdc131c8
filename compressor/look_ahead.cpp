#include "compressor/look_ahead.h"

#include <algorithm>
#include <vector>

#include "compressor/packed/block_sample.h"
#include "compressor/survey/resident_survey.h"
#include "compressor/survey/survey.h"
#include "compressor/team/region_share.h"
#include "format/base/trace.h"

namespace weir {
namespace {

// Returns the number of chunks that hold a part of `box`.
std::int64_t chunks_under(const Box& box, const AccessShape& access) {
  const auto along = [](std::int64_t lo, std::int64_t hi, std::int64_t origin, std::int64_t chunk) {
    return floor_div(hi - 1 - origin, chunk) - floor_div(lo - origin, chunk) + 1;
  };
  const Index3& origin = access.chunk_origin;
  return along(box.lo.x, box.hi.x, origin.x, access.chunk.x) * along(box.lo.y, box.hi.y, origin.y, access.chunk.y) *
         along(box.lo.z, box.hi.z, origin.z, access.chunk.z);
}

// Returns whether the sample decodes at most a quarter of the chunks that a pass over the volume decodes.
bool is_quick(const VolumeSource& source, const BlockPlan& plan, const std::vector<Box>& sampled) {
  const AccessShape access = source.access();
  if (access.chunk == Index3{}) return true;
  std::int64_t chunks = 0;
  for (const Box& row : sampled) chunks += chunks_under(plan.voxel_box(row), access);
  return chunks <= chunks_under(source.info().domain(), access) / 4;
}

// Adds the parts of `row` to `parts`. Each part's values fit a block of `plan`.
void add_parts(const Box& row, const BlockPlan& plan, std::vector<Box>& parts) {
  constexpr auto kLeafBytes = static_cast<std::uint64_t>(kLeafVoxels) * sizeof(float);
  const auto most = static_cast<std::int64_t>(std::max<std::uint64_t>(1, plan.block_bytes / kLeafBytes));
  for (std::int64_t x = row.lo.x; x < row.hi.x; x += most) {
    Box part = row;
    part.lo.x = x;
    part.hi.x = std::min(x + most, row.hi.x);
    parts.push_back(part);
  }
}

}  // namespace

std::optional<BudgetOutlook> look_ahead(VolumeSource& source, const ReadingPlan& reading, RowStore& rows,
                                        const ConversionOptions& options, const LadderAim& aim,
                                        const StreamOptions& stream) {
  const BlockPlan& plan = reading.survey;
  const std::vector<Box> sampled = BlockSample(plan.lattice).rows();
  if (!aim.has_rungs() || options.scene || plan.lattice.size() < kLeastForecastBlocks) return std::nullopt;
  if (!is_quick(source, plan, sampled)) return std::nullopt;
  const TraceSpan span(stream.trace, "look ahead");
  Team& team = rows.team();
  const OwnLeaves own(plan.lattice, team);
  std::vector<Box> leaf_boxes;
  for (const Box& row : sampled) {
    for (const Box& part : own.of(row)) add_parts(part, plan, leaf_boxes);
  }
  StreamOptions quiet;
  quiet.cancel = stream.cancel;
  quiet.trace = stream.trace;
  ResidentVolume* const resident = source.resident();
  if (resident != nullptr && team.alone() && !aim.lattice) {
    survey_resident_sample(*resident, source, rows, aim, leaf_boxes, quiet);
  } else {
    BlockSurvey survey(source.info(), rows, nullptr, false, stream.trace, aim);
    team.run([&] { survey_boxes(source, plan, leaf_boxes, quiet, reading.reading, survey); });
  }
  team.publish(rows.file());
  team.publish(rows.ladders()->file());
  FileRequest request;
  request.budget = options.budget;
  request.domain = source.info().domain();
  request.packed.preview = options.preview;
  return outlook_of(request, rows);
}

}  // namespace weir
