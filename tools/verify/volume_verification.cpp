#include "tools/verify/volume_verification.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "compressor/file_digest.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "tools/report/foreign_file.h"
#include "tools/verify/certificate_check.h"
#include "tools/verify/lossless_check.h"

namespace weir {
namespace {

void stop_if_cancelled(const VerificationWatch& watch) {
  if (watch.cancel != nullptr && *watch.cancel) throw Error(ErrorKind::interrupted, "interrupted");
}

// Releases the pages of a file during a pass, because mapped pages count as the process's memory.
class PageRelease {
 public:
  explicit PageRelease(const FileMapping& mapping) : mapping_(mapping) {}
  ~PageRelease() { mapping_.release_pages(); }
  PageRelease(const PageRelease&) = delete;
  PageRelease& operator=(const PageRelease&) = delete;

  // Tells that `done` bytes of the pass are done.
  void advanced(std::uint64_t done) {
    constexpr std::uint64_t kMostPages = std::uint64_t{32} << 20U;
    if (done < released_ + kMostPages) return;
    released_ = done;
    mapping_.release_pages();
  }

 private:
  const FileMapping& mapping_;
  std::uint64_t released_ = 0;
};

std::string watched_digest(const FileMapping& file, const VerificationWatch& watch) {
  const std::uint64_t bytes = file.bytes().size();
  if (watch.pass_started) watch.pass_started("digest", bytes);
  const TraceSpan pass(watch.trace, "digest", bytes);
  PageRelease pages(file);
  const Digest digest = digest_of_mapping(file.bytes(), watch.trace, [&](std::uint64_t done) {
    pages.advanced(done);
    if (watch.pass_advanced) watch.pass_advanced(done);
    stop_if_cancelled(watch);
  });
  return digest.hex();
}

TreeCensus watched_census(const NvdbGrid& grid, const FileMapping& file, const VerificationWatch& watch) {
  PageRelease pages(file);
  const auto leaves = static_cast<double>(std::max<std::uint64_t>(census_blocks(grid), 1));
  const auto bytes = static_cast<double>(grid.data_bytes());
  if (watch.pass_started) watch.pass_started("leaves", grid.data_bytes());
  const TraceSpan pass(watch.trace, "leaves", grid.data_bytes());
  const auto progress = [&](std::uint64_t done) {
    const auto done_bytes = static_cast<std::uint64_t>(bytes * static_cast<double>(done) / leaves);
    pages.advanced(done_bytes);
    if (watch.pass_advanced) watch.pass_advanced(done_bytes);
    stop_if_cancelled(watch);
  };
  return take_census(grid, progress, watch.trace);
}

// Detects a commit of --overwrite that was killed: it leaves the new sidecar beside the old volume, and also the
// volume's own sidecar.
std::optional<VolumeCheck> find_killed_overwrite(const std::string& path, const std::string& digest,
                                                 const Sidecar& sidecar) {
  const std::string in_place = find_sidecar(path);
  const std::string previous = previous_path(in_place);
  if (sidecar.file.digest == digest || !is_there(previous)) return std::nullopt;
  try {
    if (read_sidecar(previous).file.digest != digest) return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;  // the other checks report what is wrong
  }
  return VolumeCheck{"sidecar",
                     cat(previous, ": is the sidecar of ", path,
                         ": an --overwrite was killed before it replaced the volume; rename it to ", in_place),
                     "", false};
}

// Runs `run` and turns a failure that ends the verification early into a failed check.
template <typename Run>
auto checked(const std::string& name, std::vector<VolumeCheck>& checks, const Run& run)
    -> std::optional<decltype(run())> {
  try {
    return run();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    checks.push_back({name, error.what(), "", false});
    return std::nullopt;
  }
}

}  // namespace

std::vector<VolumeCheck> verify_volume(const std::string& path, const VerificationWatch& watch) {
  std::vector<VolumeCheck> checks;
  const auto file = checked("structure", checks, [&] {
    const TraceSpan span(watch.trace, "open");
    refuse_foreign_file(path);
    return std::make_unique<NvdbFile>(path);
  });
  if (!file) return checks;  // a sidecar says nothing about a file that is no volume
  const auto sidecar = checked("sidecar", checks, [&] { return read_sidecar(find_sidecar(path)); });
  const NvdbGrid& grid = (*file)->grid();
  const auto census = checked("structure", checks, [&] { return watched_census(grid, (*file)->mapping(), watch); });
  if (!census) return checks;
  checks.push_back({"structure", "valid", "a valid NanoVDB file", true});
  for (VolumeCheck& check : check_structure(grid, *census)) checks.push_back(std::move(check));
  if (!sidecar) return checks;
  const std::string digest = watched_digest((*file)->mapping(), watch);
  if (auto killed = find_killed_overwrite(path, digest, *sidecar)) checks.push_back(*std::move(killed));
  for (VolumeCheck& check : check_sidecar(grid, *census, digest, *sidecar)) checks.push_back(std::move(check));
  for (VolumeCheck& check : check_certificate(*sidecar)) checks.push_back(std::move(check));
  for (VolumeCheck& check : check_lossless(*census, grid.background(), *sidecar)) checks.push_back(std::move(check));
  return checks;
}

}  // namespace weir
