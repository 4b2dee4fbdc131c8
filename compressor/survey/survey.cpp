#include "compressor/survey/survey.h"

#include <algorithm>
#include <span>
#include <vector>

#include "compressor/survey/resident_survey.h"
#include "compressor/survey/row_pieces.h"
#include "compressor/survey/tally_json.h"
#include "compressor/team/region_share.h"
#include "format/io/digest.h"

namespace weir {
namespace {

// Merges the tallies of all ranks. Afterwards every rank holds the merged tally.
void merge_tallies(SurveyTally& tally, Team& team) {
  if (team.alone()) return;
  const auto text_of = [](const Team::Bytes& bytes) {
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  const auto bytes_of = [](const SurveyTally& some) {
    const std::string text = tally_text(some);
    const auto bytes = std::as_bytes(std::span(text));
    return Team::Bytes(bytes.begin(), bytes.end());
  };
  Team::Bytes part = bytes_of(tally);
  team.merge(part, [&](Team::Bytes& lower, const Team::Bytes& higher) {
    SurveyTally both = parse_tally(text_of(lower));
    both.merge(parse_tally(text_of(higher)));
    lower = bytes_of(both);
  });
  tally = parse_tally(text_of(part));
}

// Returns whether the device that holds the volume surveys it. A device only looks at the rungs of packed blocks, and
// no journal keeps its survey.
bool surveys_resident(VolumeSource& source, const RowStore& rows, const SurveyTask& task) {
  const bool rungs = task.ladders && task.ladders->has_rungs() && !task.ladders->lattice;
  const bool begun = task.state != nullptr && !task.state->done.empty();
  return source.resident() != nullptr && rows.team().alone() && rungs && !begun && !task.widths &&
         task.faces == nullptr;
}

}  // namespace

Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     const SurveyTask& task) {
  if (surveys_resident(source, rows, task)) {
    return survey_resident(*source.resident(), source, rows, *task.ladders, options);
  }
  BlockSurvey survey(source.info(), rows, task.faces, task.widths, options.trace, task.ladders);
  SurveyState from_nothing;
  SurveyState& known = task.state == nullptr ? from_nothing : *task.state;
  const SurveyTally before = known.tally;

  Team& team = rows.team();
  const OwnLeaves own(plan.lattice, team);
  std::vector<Box> leaf_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : known.done.missing_from(plan.leaf_box(i))) {
      for (const Box& own_part : own.of(part)) leaf_boxes.push_back(own_part);
    }
  }
  StreamOptions stream = options;
  std::size_t told = 0;
  const auto tell = [&](std::size_t boxes_done) {
    for (; told < boxes_done; ++told) known.done.add(leaf_boxes[told]);
    known.tally = before;
    known.tally.merge(survey.tally());
  };
  if (task.pauses.due) {
    stream.at_rest = [&](std::size_t boxes_done) {
      if (!task.pauses.due()) return;
      tell(boxes_done);
      task.pauses.save();
    };
  }
  stream.in_parts = !task.ladders || task.ladders->surveying_coder() == nullptr;  // a coder needs all voxels
  team.run([&] { survey_boxes(source, plan, leaf_boxes, stream, task.reading, survey); });
  tell(leaf_boxes.size());
  merge_tallies(known.tally, team);
  team.publish(rows.file());
  if (task.faces != nullptr) team.publish(task.faces->file());
  if (task.ladders) team.publish(rows.ladders()->file());
  return survey.result(known.tally);
}

void survey_boxes(VolumeSource& source, const BlockPlan& plan, std::span<const Box> leaf_boxes,
                  const StreamOptions& options, Reading reading, BlockSurvey& survey) {
  std::vector<Box> boxes;
  boxes.reserve(leaf_boxes.size());
  for (const Box& box : leaf_boxes) boxes.push_back(plan.voxel_box(box));
  const bool in_place = reading == Reading::in_place;
  const auto sharing = in_place ? BlockSurvey::Sharing::alone : BlockSurvey::Sharing::shared;
  (in_place ? work_in_place : stream_blocks)(
      source, boxes, options, [&](const Block& block) { survey.add(block, leaf_boxes[block.index], sharing); });
}

std::string source_digest(const RowStore& rows) {
  constexpr std::int64_t kBatch = 1 << 18;  // leaves; their digests are in memory at the same time
  DigestStream digest;
  std::vector<Digest> digests;
  const std::int64_t total = rows.leaves().size();
  for (std::int64_t begin = 0; begin < total; begin += kBatch) {
    const std::int64_t end = std::min(begin + kBatch, total);
    digests.resize(static_cast<std::size_t>(end - begin));
    for_each_row_piece(rows, begin, end, [&](std::int64_t first, std::span<const LeafRow> piece) {
      std::transform(piece.begin(), piece.end(), digests.begin() + (first - begin),
                     [](const LeafRow& row) { return row.digest; });
    });
    digest.update(digests);
  }
  return digest.digest().hex();
}

}  // namespace weir
