#include "compressor/select/encoding_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "compressor/select/float_bound.h"
#include "format/base/text.h"

namespace weir {
namespace {

// Return whether a packed file is too short for an optional preview.
bool is_short(std::uint64_t file_bytes, std::uint64_t preview_bytes) {
  return file_bytes < kLeastOfPreview * preview_bytes;
}
bool is_short(const FilePlan& file) { return is_short(file.size.bytes, file.plan.layout.node_bytes()); }

// One encoding's selection, before and after the size is known.
class Candidate {
 public:
  Candidate(const FileRequest& request, Encoding encoding, const RowStore& rows, WorkDirectory& work,
            bool preview = true)
      : request_(request),
        rows_(rows),
        work_(work),
        encoding_(encoding),
        tree_(std::make_unique<TreeRegions>(request.domain)),
        selection_(rule_of(request, encoding, preview), rows, *tree_, search_of(request.budget)) {}

  const SelectionBytes& bytes() const { return bytes_; }
  bool lossless() const { return bytes_.lossy_leaves == 0; }
  FileSize size_for(const Budget& budget) const {
    const std::uint64_t dense = float32_bytes(request_.domain);
    return file_size_for(budget, dense, bytes_, request_.path);
  }

  /// Returns whether the smallest file fits the budget, which is a size.
  bool fits(const Budget& budget) const {
    const std::uint64_t dense = float32_bytes(request_.domain);
    return bytes_.minimum.file_bytes <= asked_bytes(budget, dense);
  }

  /// Makes the first choice for the budget. For an error target, that is the smallest file with an expected error that
  /// meets it.
  void choose() {
    if (!request_.budget.by_error()) {
      size_ = size_for(request_.budget);
      selection_.choose(size_.bytes);
    } else if (request_.budget.kind == Budget::Kind::psnr) {
      size_ = {0, "psnr", ""};
      const bool lowered_to_nothing = request_.planned_error < request_.squared_error && request_.planned_error == 0;
      lowered_to_nothing && !ends_exact() ? choose_everything() : selection_.choose_error(target());
    } else {
      size_ = {0, "max_error", ""};
      selection_.choose(bytes_.minimum.file_bytes);  // the target's required leaves are all there is to buy
    }
  }

  /// Returns whether, before it is planned, the chosen file is certain to be too short for its preview.
  bool is_sure_to_be_short() const {
    const std::optional<Selection::PreviewedBytes> bytes = selection_.previewed_bytes();
    return bytes &&
           is_short(bytes->most_of_file + bytes->most_of_file / 64, bytes->preview);  // more than roundings cost
  }

  /// Plans the chosen file. For a PSNR, if blocks can be kept without loss, the planned file meets it.
  FilePlan plan_chosen() {
    FilePlan file = plan_until_met();
    selection_.release_steps();  // another candidate may need their memory
    return file;
  }

  FilePlan plan(const FileSize& size) {
    selection_.choose(size.bytes);
    FilePlan file = planned(size);
    selection_.release_steps();
    return file;
  }

 private:
  FilePlan plan_until_met() {
    FilePlan file = planned(size_);
    if (request_.budget.kind != Budget::Kind::psnr || !ends_exact()) return file;
    // The plan's error can come as near to 0 as is asked. Because sums round, the target is lowered until it is met.
    for (double slack = 0x1p-48; file.plan.expected_error > target(); slack *= 256) {
      tree_ = std::move(file.tree);
      slack < 1 ? selection_.choose_error(target() * (1 - slack)) : choose_everything();
      file = planned(size_);
      if (!(slack < 1)) return file;
    }
    return file;
  }

  // Returns whether buying every step leaves no error.
  bool ends_exact() const { return encoding_ == Encoding::float32 || encoding_ == Encoding::packed; }
  // Returns the squared error that a plan for a PSNR may have at most.
  double target() const { return encoding_ == Encoding::float32 ? request_.squared_error : request_.planned_error; }
  void choose_everything() { selection_.choose(bytes_.full.file_bytes); }

  FilePlan planned(const FileSize& size) {
    FilePlan file;
    file.encoding = encoding_;
    file.fill = request_.rule.fill;
    file.cut = selection_.cut_key();
    file.choices = std::make_unique<ChoiceStore>(work_.spill_records(), tree_->region_lattice.size());
    file.packed = selection_.rule().packed;
    if (file.packed) {
      file.streams = std::make_unique<PlannedStreamsStore>(work_.spill_records(), tree_->region_lattice.size());
    }
    file.plan = plan_tree(selection_, rows_, *tree_, *file.choices, file.streams.get());
    file.size = size;
    if (size.bytes == 0) file.size.bytes = file.plan.layout.file_bytes;
    file.plan.layout = padded_to(file.plan.layout, file.size.bytes);
    file.tree = std::move(tree_);
    return file;
  }

  // Returns the kind of cut to search for. With a largest error for every voxel, or without loss, there is nothing to
  // choose.
  static Selection::Search search_of(const Budget& budget) {
    if (budget.kind == Budget::Kind::lossless || budget.kind == Budget::Kind::max_error) return Selection::Search::no;
    return budget.kind == Budget::Kind::psnr ? Selection::Search::of_error : Selection::Search::of_bytes;
  }

  // Returns a bound of the squared error: every voxel reads a value in the volume's range, or the background.
  static double most_error(const FileRequest& request) {
    const auto background = static_cast<double>(request.rule.fill.background);
    const double low = std::min(static_cast<double>(request.packed.constants.minimum), background);
    const double high = std::max(static_cast<double>(request.packed.constants.maximum), background);
    return (high - low) * (high - low) * static_cast<double>(request.domain.voxels());
  }

  static GainRule rule_of(const FileRequest& request, Encoding encoding, bool preview) {
    GainRule rule = request.rule;
    rule.encoding = encoding;
    if (encoding == Encoding::packed) {
      rule.packed = PackedRule{preview, request.packed.constants.coarsest, request.packed.window, most_error(request)};
    }
    if (request.budget.kind == Budget::Kind::max_error) rule.max_error = request.budget.target;
    return rule;
  }

  const FileRequest& request_;
  const RowStore& rows_;
  WorkDirectory& work_;
  Encoding encoding_;
  std::unique_ptr<TreeRegions> tree_;
  Selection selection_;
  SelectionBytes bytes_ = selection_.bytes();
  FileSize size_;  // size of the chosen file; 0 bytes: as many as it takes
};

bool can_quantise(const FileRequest& request) {
  return request.rule.metric == Metric::sse && !request.keeps_non_finite;
}

bool countable(const FilePlan& file) { return countable(file.plan.layout.counts); }

// Returns the reason why a quantised file cannot be lossless.
std::string lossy_leaves_text(const Candidate& quantised) {
  const std::uint64_t leaves = quantised.bytes().lossy_leaves;
  return cat(leaves, leaves == 1 ? " block needs" : " blocks need", " full float32");
}

// Returns whether the file is expected to meet the request.
bool meets(const FileRequest& request, const Candidate& candidate, const FilePlan& file) {
  if (request.budget.kind != Budget::Kind::psnr) return candidate.lossless();
  return file.plan.expected_error <= (request.adjusted ? request.planned_error : request.squared_error);
}

// Throws Error(budget) if the budget is lossless and the encoding cannot be.
void check_lossless(const FileRequest& request, Encoding encoding, const Candidate& candidate) {
  if (request.budget.kind != Budget::Kind::lossless || candidate.lossless()) return;
  throw Error(ErrorKind::budget, compose(request.path, ": ", option("encoding", encoding_name(encoding)),
                                         " cannot be lossless: ", lossy_leaves_text(candidate), "; use ",
                                         option("encoding", "auto"), " or float"));
}

// Throws Error(budget) if the encoding cannot meet the asked largest error. For a PSNR it does not throw, because the
// plan's PSNR is only expected: decoded values decide.
void check_target(const FileRequest& request, Encoding encoding, const Candidate& candidate, const FilePlan& file) {
  if (request.budget.kind != Budget::Kind::max_error || request.adjusted || meets(request, candidate, file)) return;
  throw unmet_target(request, encoding, file.plan.expected_error);
}

// Plans the file of one encoding for the budget.
FilePlan plan_by_budget(const FileRequest& request, Encoding encoding, Candidate& candidate) {
  check_lossless(request, encoding, candidate);
  candidate.choose();
  FilePlan file = candidate.plan_chosen();
  check_target(request, encoding, candidate, file);
  return file;
}

// Plans the packed file with a preview. Returns nullopt if it is not long enough for a preview.
std::optional<FilePlan> plan_previewed(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  Candidate candidate(request, Encoding::packed, rows, work, true);
  const bool asks_size = request.budget.by_size() || request.budget.kind == Budget::Kind::automatic;
  if (asks_size && !candidate.fits(request.budget)) return std::nullopt;
  check_lossless(request, Encoding::packed, candidate);
  candidate.choose();
  if (candidate.is_sure_to_be_short()) return std::nullopt;
  FilePlan file = candidate.plan_chosen();
  if (is_short(file)) return std::nullopt;
  check_target(request, Encoding::packed, candidate, file);
  return file;
}

FilePlan plan_packed(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  if (request.packed.preview == Preview::automatic) {
    if (std::optional<FilePlan> file = plan_previewed(request, rows, work)) return std::move(*file);
  }
  Candidate candidate(request, Encoding::packed, rows, work, request.packed.preview == Preview::on);
  return plan_by_budget(request, Encoding::packed, candidate);
}

FilePlan plan_one(const FileRequest& request, Encoding encoding, const RowStore& rows, WorkDirectory& work) {
  if (encoding == Encoding::packed) return plan_packed(request, rows, work);
  if (encoding != Encoding::float32 && request.keeps_non_finite) {
    throw Error(ErrorKind::usage,
                compose(option("encoding", encoding_name(encoding)), " holds no NaN or infinite voxels, which ",
                        option("nonfinite", "keep"), " asks for; use ", option("encoding", "float")));
  }
  Candidate candidate(request, encoding, rows, work);
  return plan_by_budget(request, encoding, candidate);
}

FilePlan plan_lossless(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  Candidate quantised(request, Encoding::fpn, rows, work);
  Candidate plain(request, Encoding::float32, rows, work);
  if (quantised.lossless() && quantised.bytes().full.file_bytes <= plain.bytes().full.file_bytes) {
    FilePlan file = quantised.plan(quantised.size_for(request.budget));
    if (countable(file)) return file;
  }
  FileSize size = plain.size_for(request.budget);
  if (!quantised.lossless()) {
    size.notice = cat(request.path, ": ", lossy_leaves_text(quantised), " to be lossless");
  }
  return plain.plan(size);
}

// Returns the bounds of a float file in place of `quantised`, if they may make planning that file unnecessary.
std::optional<FloatBound> float_bound(const FileRequest& request, const RowStore& rows, const FilePlan& quantised) {
  const bool weighed = request.rule.visibility != nullptr;  // the bound is of what all voxels lose
  if (request.plans_float || weighed || !countable(quantised) || !rows.team().alone()) return std::nullopt;
  return FloatBound(*quantised.tree, rows);
}

FilePlan plan_best(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  Candidate candidate(request, Encoding::fpn, rows, work);
  const FileSize size = candidate.size_for(request.budget);
  FilePlan quantised = candidate.plan(size);
  if (quantised.plan.loses_nothing && countable(quantised)) return quantised;
  // A quantised file may be shorter than the allowed size if it cannot use more bytes.
  const std::uint64_t dense = float32_bytes(request.domain);
  const std::uint64_t allowed = request.budget.by_size() ? asked_bytes(request.budget, dense) : size.bytes;
  if (const std::optional<FloatBound> bound = float_bound(request, rows, quantised)) {
    const double least = bound->least_error(allowed);
    if (least > 0 && quantised.plan.expected_error <= least) {  // without error, the bits decide
      quantised.float_error = least;
      quantised.float_error_is_bound = true;
      return quantised;
    }
  }
  Candidate other(request, Encoding::float32, rows, work);
  if (other.bytes().minimum.file_bytes > allowed) return quantised;
  if (size.kind == "minimum") return quantised;
  FilePlan plain = other.plan(other.size_for(request.budget));
  if (countable(plain) != countable(quantised)) return std::move(countable(plain) ? plain : quantised);
  if (request.rule.visibility != nullptr) {  // weighted errors are not measured: expected errors decide
    return plain.plan.expected_error <= quantised.plan.expected_error ? std::move(plain) : std::move(quantised);
  }
  if (plain.plan.expected_error == 0) return plain;
  // The estimate may be wrong by a factor of a million if values lie near a lattice that a width happens to hold.
  quantised.float_error = plain.plan.expected_error;
  return quantised;
}

FilePlan plan_smallest(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  Candidate quantised(request, Encoding::fpn, rows, work);
  quantised.choose();
  FilePlan small = quantised.plan_chosen();
  if (request.budget.kind == Budget::Kind::psnr && meets(request, quantised, small)) {
    const std::optional<FloatBound> bound = float_bound(request, rows, small);
    if (bound && small.size.bytes <= bound->least_bytes(request.squared_error)) return small;
  }
  Candidate plain(request, Encoding::float32, rows, work);
  plain.choose();
  FilePlan file = plain.plan_chosen();
  const bool as_small = small.size.bytes <= file.size.bytes || !countable(file);
  return std::move(meets(request, quantised, small) && countable(small) && as_small ? small : file);
}

}  // namespace

Error unmet_target(const FileRequest& request, Encoding encoding, double squared_error) {
  if (encoding == Encoding::packed) {
    return {ErrorKind::internal, cat(request.path, ": packed blocks miss what was asked; report this")};
  }
  const bool psnr = request.budget.kind == Budget::Kind::psnr;
  std::string best;
  if (request.budget.kind == Budget::Kind::lossless) {
    return {ErrorKind::budget, compose(request.path, ": ", option("encoding", encoding_name(encoding)),
                                       " cannot be lossless: a leaf of it reads other bits; use ",
                                       option("encoding", "auto"), " or float")};
  }
  if (psnr && squared_error > 0 && request.squared_error > 0) {
    const double short_by = 10 * std::log10(squared_error / request.squared_error);
    best = cat(" reaches about ", std::floor((request.budget.target - short_by) * 10) / 10, " dB at most");
  } else {
    const unsigned bits = 1U << bits_log2_of(widths_of(encoding).back());
    best = cat(" has leaves whose range ", bits, " bits do not divide that finely");
  }
  return {ErrorKind::budget, compose(request.path, ": ", option(psnr ? "psnr" : "max-error", request.budget.target),
                                     " cannot be met: ", option("encoding", encoding_name(encoding)), best, "; use ",
                                     option("encoding", "auto"), " or float")};
}

FilePlan plan_file(const FileRequest& request, const RowStore& rows, WorkDirectory& work) {
  FilePlan file = [&] {
    if (request.encoding != Encoding::automatic) return plan_one(request, request.encoding, rows, work);
    if (!can_quantise(request)) return plan_one(request, Encoding::float32, rows, work);
    if (request.budget.by_error()) return plan_smallest(request, rows, work);
    if (request.budget.kind == Budget::Kind::lossless) return plan_lossless(request, rows, work);
    return plan_best(request, rows, work);
  }();
  check_countable(file.plan.layout.counts, request.path);
  if (!request.pads_file) {
    file.size.bytes = file.plan.layout.content_end;
    file.plan.layout = padded_to(file.plan.layout, file.size.bytes);
  }
  return file;
}

}  // namespace weir
