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

// The digest that the sidecar has of this very file.
std::optional<std::string> certified_digest(const std::string& path, const std::string& sidecar, const Notice& notice) {
  const auto say = [&](const std::string& why) {
    if (notice) notice(cat(why, "; whether ", path, " is damaged is not known"));
  };
  try {
    Sidecar read = read_sidecar(sidecar);
    if (is_of(read, NvdbFile(path).grid())) return read.file.digest;
    say(cat(sidecar, ": is of another volume than ", path));
  } catch (const Error& error) {
    say(error.what());
  }
  return std::nullopt;
}

}  // namespace

void refuse_damaged(const std::string& path, const DamageWatch& watch) {
  const std::string sidecar = find_sidecar(path);
  if (!is_there(sidecar)) return;
  const std::optional<std::string> certified = certified_digest(path, sidecar, watch.notice);
  if (!certified) return;
  const std::unique_ptr<File> file = make_posix_file_system()->open_to_read(path);
  if (watch.started) watch.started(file->size());
  if (digest_of_file(*file, no_team(), watch.advanced).hex() == *certified) return;
  throw input_error(path, cat("has other bytes than ", sidecar,
                              " certifies: a copy broke off, or a disk or memory is faulty; copy it or convert it "
                              "again, or move the sidecar away to take the values as they are"));
}

}  // namespace weir
