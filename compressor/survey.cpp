#include "compressor/survey.h"

#include "compressor/block_survey.h"
#include "format/digest.h"

namespace weir {

Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     Reading reading, bool widths, LeafStore<LeafFaces>* faces, SurveyState* state,
                     const Pauses& pauses) {
  BlockSurvey survey(source.info(), rows, faces, widths, options.trace);
  SurveyState from_nothing;
  SurveyState& known = state == nullptr ? from_nothing : *state;
  const SurveyTally before = known.tally;

  std::vector<Box> leaf_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : known.done.missing_from(plan.leaf_box(i))) leaf_boxes.push_back(part);
  }
  std::vector<Box> boxes;
  boxes.reserve(leaf_boxes.size());
  for (const Box& box : leaf_boxes) boxes.push_back(plan.voxel_box(box));

  StreamOptions stream = options;
  std::size_t told = 0;
  const auto tell = [&](std::size_t boxes_done) {
    for (; told < boxes_done; ++told) known.done.add(leaf_boxes[told]);
    known.tally = before;
    known.tally.merge(survey.tally());
  };
  if (pauses.due) {
    stream.at_rest = [&](std::size_t boxes_done) {
      if (!pauses.due()) return;
      tell(boxes_done);
      pauses.save();
    };
  }
  const bool in_place = reading == Reading::in_place;
  const auto sharing = in_place ? BlockSurvey::Sharing::alone : BlockSurvey::Sharing::shared;
  (in_place ? work_in_place : stream_blocks)(
      source, boxes, stream, [&](const Block& block) { survey.add(block, leaf_boxes[block.index], sharing); });
  tell(boxes.size());
  return survey.result(known.tally);
}

std::string source_digest(const RowStore& rows) {
  constexpr std::int64_t kPiece = 4096;
  DigestStream digest;
  std::vector<LeafRow> piece;
  const std::int64_t total = rows.leaves().size();
  for (std::int64_t first = 0; first < total; first += kPiece) {
    piece.resize(static_cast<std::size_t>(std::min(kPiece, total - first)));
    rows.read(first, piece);
    for (const LeafRow& row : piece) digest.update(row.digest);
  }
  return digest.digest().hex();
}

}  // namespace weir
