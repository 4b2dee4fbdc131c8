#include "compressor/damaged_input.h"

#include <memory>
#include <optional>

#include "compressor/file_digest.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/read_sidecar.h"

namespace weir {
namespace {

// Returns the sidecar if it can be read and describes the file at `path`. Otherwise tells `notice` why not.
std::optional<Sidecar> certificate_of(const std::string& path, const std::string& sidecar, const Notice& notice) {
  const auto say = [&](const std::string& why) {
    if (notice) notice(cat(why, "; whether ", path, " is damaged is not known"));
  };
  try {
    Sidecar read = read_sidecar(sidecar);
    if (is_of(read, NvdbFile(path))) return read;
    say(cat(sidecar, ": is of another volume than ", path));
  } catch (const Error& error) {
    say(error.what());
  }
  return std::nullopt;
}

}  // namespace

void refuse_damaged(const std::string& path, const Sidecar& certificate, const DamageWatch& watch) {
  const std::unique_ptr<File> file = make_posix_file_system()->open_to_read(path);
  if (watch.started) watch.started(file->size());
  if (digest_of_file(*file, no_team(), watch.advanced).hex() == certificate.file.digest) return;
  throw input_error(path, cat("has other bytes than ", find_sidecar(path),
                              " certifies: a copy broke off, or a disk or memory is faulty; copy it or convert it "
                              "again, or move the sidecar away to take the values as they are"));
}

void refuse_damaged(const std::string& path, const DamageWatch& watch) {
  const std::string sidecar = find_sidecar(path);
  if (!is_there(sidecar)) return;
  if (const auto certificate = certificate_of(path, sidecar, watch.notice)) refuse_damaged(path, *certificate, watch);
}

}  // namespace weir
