#include "tools/verify/volume_verification.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "compressor/file_digest.h"
#include "format/base/error.h"
#include "format/base/text.h"
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

std::string watched_digest(std::span<const std::byte> file, const VerificationWatch& watch) {
  if (watch.pass_started) watch.pass_started("digest", file.size());
  const TraceSpan pass(watch.trace, "digest", file.size());
  const Digest digest = digest_of_mapping(file, watch.trace, [&](std::uint64_t done) {
    if (watch.pass_advanced) watch.pass_advanced(done);
    stop_if_cancelled(watch);
  });
  return digest.hex();
}

TreeCensus watched_census(const NvdbGrid& grid, const VerificationWatch& watch) {
  const auto leaves = static_cast<double>(std::max<std::uint64_t>(census_blocks(grid), 1));
  const auto bytes = static_cast<double>(grid.data_bytes());
  if (watch.pass_started) watch.pass_started("leaves", grid.data_bytes());
  const TraceSpan pass(watch.trace, "leaves", grid.data_bytes());
  const auto progress = [&](std::uint64_t done) {
    if (watch.pass_advanced) {
      watch.pass_advanced(static_cast<std::uint64_t>(bytes * static_cast<double>(done) / leaves));
    }
    stop_if_cancelled(watch);
  };
  return take_census(grid, progress, watch.trace);
}

// Failures that end the verification early become a check like any other.
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
  if (!file) return checks;  // of what is no volume a sidecar says nothing
  const auto sidecar = checked("sidecar", checks, [&] { return read_sidecar(find_sidecar(path)); });
  const NvdbGrid& grid = (*file)->grid();
  const auto census = checked("structure", checks, [&] { return watched_census(grid, watch); });
  if (!census) return checks;
  checks.push_back({"structure", "valid", "a valid NanoVDB file", true});
  for (VolumeCheck& check : check_structure(grid, *census)) checks.push_back(std::move(check));
  if (!sidecar) return checks;
  const std::string digest = watched_digest(grid.bytes(), watch);
  for (VolumeCheck& check : check_sidecar(grid, *census, digest, *sidecar)) checks.push_back(std::move(check));
  for (VolumeCheck& check : check_certificate(*sidecar)) checks.push_back(std::move(check));
  for (VolumeCheck& check : check_lossless(*census, grid.background(), *sidecar)) checks.push_back(std::move(check));
  return checks;
}

}  // namespace weir
