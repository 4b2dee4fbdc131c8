#include "compressor/push/pushed_volume.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "compressor/conversion_control.h"
#include "compressor/conversion_memory.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/own_threads.h"
#include "compressor/plan/startable_threads.h"
#include "compressor/push/leaf_spool.h"
#include "compressor/push/plane_set.h"
#include "compressor/push/slice_intake.h"
#include "compressor/push/spool_source.h"
#include "compressor/resume.h"
#include "compressor/resume/work_directory.h"
#include "compressor/survey/block_survey.h"
#include "compressor/surveyed_conversion.h"
#include "format/base/error.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "format/output/output_files.h"
#include "format/process/fork_guard.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/source/extent.h"
#include "ingest/values/array_source.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

// Plans memory with 0 bytes in use: the memory that the process holds is the simulation's and no part of the ceiling.
MemoryPlan memory_for(const ConversionOptions& options, std::size_t threads, const Box& domain) {
  return plan_memory(options.memory, 0, threads, domain, region_bytes(options), record_bytes(options, domain));
}

// Returns a plan of slices that fit a worker's cache, several of which fit `bytes`: whole rows of leaves if they fit.
BlockPlan plan_slices(const Box& domain, std::size_t value_bytes, std::uint64_t bytes) {
  constexpr std::int64_t kMostLeaves = 512;  // a MiB of float32
  constexpr std::uint64_t kLeastSlices = 8;
  const std::uint64_t fit = bytes / (kLeastSlices * kLeafVoxels * value_bytes);
  const std::int64_t leaves = std::clamp<std::int64_t>(static_cast<std::int64_t>(fit), 1, kMostLeaves);
  BlockPlan plan;
  plan.lattice = make_lattice(domain, kLeafDim);
  const Index3& count = plan.lattice.count;
  plan.leaves.x = std::min(leaves, count.x);
  plan.leaves.y = std::clamp<std::int64_t>(leaves / count.x, 1, count.y);
  plan.leaves.z = 1;
  plan.count = {ceil_div(count.x, plan.leaves.x), ceil_div(count.y, plan.leaves.y), count.z};
  return plan;
}

// The files that a push keeps on the disk until it ends, with or without success.
struct PushedFiles {
  PushedFiles(const SourceInfo& info, const ConversionOptions& options, const ConversionControl& control, bool faces,
              const MemoryPlan& memory, FileSystem& files)
      : output(files, options.output, options.overwrite), work(files, options.output, options.work_dir) {
    if (remove_leftovers(files, options.output) && control.notice) control.notice(leftovers_notice(options.output));
    if (memory.record_bytes > 0) work.hold_records(MemoryFileSystem::PagesOf::the_system);
    const NodeLattice leaves = make_lattice(info.domain(), kLeafDim);
    std::optional<LadderAim> ladders = surveyed_ladders(options, info);
    if (ladders) ladders->coder = control.coder;
    stores.emplace(make_survey_stores([this](const char*) { return work.spill_records(); }, leaves, memory.selection,
                                      faces, ladders.has_value()));
    spool.emplace(work.spill(), work.spill(), leaves, info.type);
    survey.emplace(info, stores->rows, faces ? &*stores->faces : nullptr, surveys_widths(options), control.trace,
                   ladders);
  }

  OutputFiles output;
  WorkDirectory work;
  std::optional<SurveyStores> stores;
  std::optional<LeafSpool> spool;
  std::optional<BlockSurvey> survey;
};

}  // namespace

class PushedVolume::State {
 public:
  State(SourceInfo info, const ConversionOptions& options, const ConversionControl& control, FileSystem& files,
        std::size_t workers)
      : info_(as_pushed(std::move(info))),
        options_(options),
        control_(control),
        threads_(choose_threads(options.threads, processors_or_all(options.processors), options.memory, 0,
                                info_.domain(), region_bytes(options))),
        memory_(memory_for(options, std::max(threads_, workers), info_.domain())),
        seen_(visibility_of(options, info_.domain())),
        files_(std::in_place, info_, options_, control_, seen_.has_value(), memory_, files),
        slices_(plan_slices(info_.domain(), scalar_bytes(info_.type), room_bytes())),
        floats_([this] { return PageBuffer(slice_voxels() * sizeof(float)); }) {
    intake_.emplace(slices_, scalar_bytes(info_.type), room(workers), sink());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void slab(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) {
    check_going_on();
    if (data == nullptr) throw Error(ErrorKind::usage, cat(info_.path, ": the slab's data is a null pointer"));
    check_slab(z0, nz, stride);
    const Taking taking(*this, z0, nz);
    add(z0, nz, data, stride);
  }

  void check_slab(std::int64_t z0, std::int64_t nz, const std::array<std::int64_t, 3>& stride) const {
    check_planes(z0, nz);
    check_strides(info_.path, {info_.extent.x, info_.extent.y, nz}, stride);
  }

  void expect(std::int64_t z0, std::int64_t nz) {
    check_going_on();
    check_planes(z0, nz);
    const std::lock_guard lock(mutex_);
    take_planes(z0, nz);
    expected_planes_ += nz;
  }

  void fill(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) {
    check_going_on();
    add(z0, nz, data, stride);
    const std::lock_guard lock(mutex_);
    expected_planes_ -= nz;
  }

  void fail(const Error& error) { intake_->fail(error); }

  Sidecar end(VolumeSource* whole) {
    const auto started = std::chrono::steady_clock::now();
    check_going_on();
    begin_end(whole != nullptr);
    intake_->finish();
    const Release release{files_};
    try {
      return whole != nullptr ? convert_whole(*whole) : convert(started);
    } catch (const Error& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error;
      throw;
    }
  }

  bool has_room_for(std::uint64_t working_bytes) const {
    try {
      check_memory(options_, info_.domain(), working_bytes);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  const SourceInfo& info() const { return info_; }

 private:
  // A slab in progress: from the check of its planes to the return of the call.
  class Taking {
   public:
    Taking(State& state, std::int64_t z0, std::int64_t nz) : state_(state) {
      const std::lock_guard lock(state_.mutex_);
      state_.take_planes(z0, nz);
      ++state_.slabs_in_progress_;
    }
    ~Taking() {
      const std::lock_guard lock(state_.mutex_);
      --state_.slabs_in_progress_;
    }
    Taking(const Taking&) = delete;
    Taking& operator=(const Taking&) = delete;

   private:
    State& state_;
  };

  // Removes the uncommitted files from the disk, however the push ends.
  struct Release {
    std::optional<PushedFiles>& files;
    ~Release() { files.reset(); }
  };

  std::uint64_t room_bytes() const { return 2 * memory_.block_bytes; }
  std::size_t slice_voxels() const {
    return static_cast<std::size_t>(volume(min(slices_.leaves * kLeafDim, info_.extent)));
  }
  IntakeRoom room(std::size_t workers) const {
    const std::uint64_t fit = room_bytes() / (slice_voxels() * scalar_bytes(info_.type));
    return {static_cast<std::size_t>(std::min<std::uint64_t>(fit, static_cast<std::uint64_t>(slices_.size()))),
            workers};
  }

  SliceSink sink() {
    return {[this](std::int64_t slice, PlaneMask parked, std::span<std::byte> values) {
              for_parked(slice, parked, values.size(), [&](std::int64_t leaf, std::size_t at, std::size_t bytes) {
                files_->spool->unpark(leaf, at, values.subspan(at, bytes));
              });
              survey_and_spool(slice, values);
            },
            [this](std::int64_t slice, PlaneMask planes, std::span<const std::byte> values) {
              for_parked(slice, planes, values.size(), [&](std::int64_t leaf, std::size_t at, std::size_t bytes) {
                files_->spool->park(leaf, at, values.subspan(at, bytes));
              });
            },
            [this] { files_.reset(); }};
  }

  // Calls visit(first leaf, offset, bytes) for every run of planes of the mask in the `bytes` of a slice. The room of
  // the slice's leaves in the spool is in one piece.
  template <typename Visit>
  void for_parked(std::int64_t slice, PlaneMask mask, std::size_t bytes, const Visit& visit) const {
    const Box leaf_box = slices_.leaf_box(slice);
    const std::size_t plane = bytes / static_cast<std::size_t>(slices_.voxel_box(leaf_box).extent().z);
    for (int first = 0; mask >> first != 0;) {
      first += std::countr_zero(static_cast<unsigned>(mask >> first));
      const int count = std::countr_one(static_cast<unsigned>(mask >> first));
      visit(slices_.lattice.linear(leaf_box.lo), static_cast<std::size_t>(first) * plane,
            static_cast<std::size_t>(count) * plane);
      first += count;
    }
  }

  void survey_and_spool(std::int64_t slice, std::span<const std::byte> values) {
    const Box leaf_box = slices_.leaf_box(slice);
    const Box voxels = slices_.voxel_box(leaf_box);
    const std::span<float> floats = floats_.local().floats().first(static_cast<std::size_t>(voxels.voxels()));
    const ConversionLoss loss = decode_values(values, info_.type, kNativeIsBig, info_.mapping, floats);
    files_->survey->add({static_cast<std::size_t>(slice), voxels, floats, loss}, leaf_box, BlockSurvey::Sharing::alone);
    const TraceSpan span(control_.trace, "spool", values.size());
    files_->spool->write(voxels, values);
  }

  void check_going_on() {
    intake_->check();
    {
      const std::lock_guard lock(mutex_);
      if (failure_) throw Error(*failure_);
      if (ended_) throw has_ended();
    }
    try {
      check_cancel(control_);
    } catch (const Error& interrupted) {
      throw intake_->fail(interrupted);
    }
  }

  void add(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) {
    const Box domain = info_.domain();
    const Box box{{domain.lo.x, domain.lo.y, domain.lo.z + z0}, {domain.hi.x, domain.hi.y, domain.lo.z + z0 + nz}};
    intake_->add({box, static_cast<const std::byte*>(data), stride, scalar_bytes(info_.type)});
  }

  void check_planes(std::int64_t z0, std::int64_t nz) const {
    if (z0 < 0 || nz < 1 || z0 >= info_.extent.z || nz > info_.extent.z - z0) {
      throw Error(ErrorKind::usage, cat(info_.path, ": a slab of ", nz, nz == 1 ? " plane" : " planes", " from ", z0,
                                        " on is not in the volume, whose planes are 0 to ", info_.extent.z - 1));
    }
  }

  void take_planes(std::int64_t z0, std::int64_t nz) {
    if (const auto twice = given_.add({z0, z0 + nz})) {
      throw Error(ErrorKind::usage, cat(info_.path, ": a slab of ", nz, nz == 1 ? " plane" : " planes", " from ", z0,
                                        " on holds ", planes_text({*twice}), ", given before; give each plane once"));
    }
  }

  void begin_end(bool whole) {
    const std::lock_guard lock(mutex_);
    if (ended_) throw has_ended();
    if (whole && expected_planes_ == info_.extent.z) expected_planes_ = 0;
    const std::vector<PlaneRange> missing = given_.missing(info_.extent.z);
    if (!missing.empty()) {
      throw Error(ErrorKind::usage, cat(info_.path, ": ", planes_text(missing), " of ", info_.extent.z,
                                        " never came; give the rest first"));
    }
    if (slabs_in_progress_ > 0) {
      throw Error(ErrorKind::usage,
                  cat(info_.path, ": ", slabs_in_progress_, slabs_in_progress_ == 1 ? " slab is" : " slabs are",
                      " still being taken; end once every call has returned"));
    }
    if (expected_planes_ > 0) {
      throw Error(ErrorKind::usage,
                  cat(info_.path, ": ", expected_planes_, expected_planes_ == 1 ? " plane is" : " planes are",
                      " still expected; end once their values have come"));
    }
    ended_ = true;
  }

  Error has_ended() const { return {ErrorKind::usage, cat(info_.path, ": the volume has ended; begin another one")}; }

  Sidecar convert(std::chrono::steady_clock::time_point started) {
    floats_.clear();
    const ForkGuard forks;
    return OwnThreads(startable_workers(threads_, control_.notice)).run([&] {
      const std::unique_ptr<VolumeSource> source = open_spool(*files_->spool, info_);
      const Survey survey = files_->survey->result(files_->survey->tally());
      return convert_surveyed({*source, options_, control_, files_->output, files_->work, nullptr, seen_},
                              plan_reading(*source, memory_), survey, *files_->stores, started);
    });
  }

  Sidecar convert_whole(VolumeSource& whole) {
    floats_.clear();
    // Nothing was surveyed or spooled: the room of these files goes to the conversion's own files.
    files_->survey.reset();
    files_->spool.reset();
    files_->stores.reset();
    return convert_into(files_->output, files_->work, whole, options_, control_, no_team());
  }

  SourceInfo info_;
  ConversionOptions options_;
  ConversionControl control_;
  std::size_t threads_;
  MemoryPlan memory_;
  std::optional<Visibility> seen_;
  std::optional<PushedFiles> files_;  // nullopt after the push has ended
  BlockPlan slices_;
  tbb::enumerable_thread_specific<PageBuffer> floats_;  // of a slice
  std::mutex mutex_;                                    // of the next five
  PlaneSet given_;
  std::int64_t slabs_in_progress_ = 0;
  std::int64_t expected_planes_ = 0;  // planes with values still to come
  bool ended_ = false;
  std::optional<Error> failure_;       // of the end
  std::optional<SliceIntake> intake_;  // last: its workers use all of the above
};

PushedVolume::PushedVolume(SourceInfo info, const ConversionOptions& options, const ConversionControl& control,
                           FileSystem& files, std::size_t workers)
    : state_(std::make_unique<State>(std::move(info), options, control, files, workers)) {}

PushedVolume::~PushedVolume() = default;

void PushedVolume::slab(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) {
  state_->slab(z0, nz, data, stride);
}

void PushedVolume::slab(std::int64_t z0, std::int64_t nz, const void* data) {
  slab(z0, nz, data, packed_stride(state_->info().extent, state_->info().type));
}

void PushedVolume::check_slab(std::int64_t z0, std::int64_t nz, const std::array<std::int64_t, 3>& stride) const {
  state_->check_slab(z0, nz, stride);
}

void PushedVolume::expect(std::int64_t z0, std::int64_t nz) { state_->expect(z0, nz); }

void PushedVolume::fill(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) {
  state_->fill(z0, nz, data, stride);
}

void PushedVolume::fail(const Error& error) { state_->fail(error); }

bool PushedVolume::has_room_for(std::uint64_t working_bytes) const { return state_->has_room_for(working_bytes); }

const SourceInfo& PushedVolume::info() const { return state_->info(); }

Sidecar PushedVolume::end() { return state_->end(nullptr); }

Sidecar PushedVolume::end(VolumeSource& whole) { return state_->end(&whole); }

}  // namespace weir
