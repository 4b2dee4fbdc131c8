#include "format/output/commit_leftovers.h"

#include <cerrno>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/io/digest.h"
#include "format/io/output_names.h"
#include "format/sidecar/is_of.h"
#include "format/sidecar/short_text.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

// Returns check(), which reads files; false if one of them is missing or not weir's. If a file exists but cannot be
// read, the question has no answer, and the Error(io) is passed on.
template <typename Check>
bool unless_foreign(const Check& check) {
  try {
    return check();
  } catch (const Error& error) {
    const bool missing = error.system_failure() && error.system_failure()->errno_value == ENOENT;
    if (!missing && error.kind() != ErrorKind::input && error.kind() != ErrorKind::usage) throw;
    return false;
  }
}

// Returns the file record of `sidecar` if it has the length and head checksum of `volume`. Another volume may have the
// same.
std::optional<Sidecar::File> head_described(FileSystem& files, const std::string& sidecar, File& volume) {
  Sidecar::File record;
  const bool agrees = unless_foreign([&] {
    record = parse_sidecar(short_text(files, sidecar), sidecar).file;
    return has_head(record, volume);
  });
  return agrees ? std::optional(std::move(record)) : std::nullopt;
}

}  // namespace

std::string commit_record(const std::string& sidecar_text) {
  return piece_digest(std::as_bytes(std::span(sidecar_text))).hex();
}

bool describes(FileSystem& files, const std::string& sidecar, File& volume) {
  const std::optional<Sidecar::File> record = head_described(files, sidecar, volume);
  return record && whole_digest(volume).hex() == record->digest;
}

bool describes(FileSystem& files, const std::string& sidecar, const std::string& volume) {
  return unless_foreign([&] { return describes(files, sidecar, *files.open_to_read(volume)); });
}

OwnSidecar find_own_sidecar(FileSystem& files, const std::string& previous, const std::string& sidecar,
                            const std::string& volume) {
  OwnSidecar own = OwnSidecar::neither;
  unless_foreign([&] {
    const std::unique_ptr<File> file = files.open_to_read(volume);
    const std::optional<Sidecar::File> in_place = head_described(files, sidecar, *file);
    const std::optional<Sidecar::File> before = head_described(files, previous, *file);
    if (in_place) {
      const std::string digest = whole_digest(*file).hex();
      if (digest == in_place->digest) {
        own = OwnSidecar::in_place;
      } else if (before && digest == before->digest) {
        own = OwnSidecar::previous;
      }
    } else if (before) {  // no need to read the volume: a damaged volume, too, gets back the sidecar that shows the
                          // damage
      own = OwnSidecar::previous;
    }
    return true;
  });
  return own;
}

bool belongs_back(FileSystem& files, const std::string& previous, const std::string& sidecar,
                  const std::string& volume) {
  return find_own_sidecar(files, previous, sidecar, volume) == OwnSidecar::previous;
}

bool placed_by_commit(FileSystem& files, const std::string& sidecar, File& partial) {
  return unless_foreign([&] {
    const std::string record = commit_record(short_text(files, sidecar));
    if (partial.size() == record.size() && short_text(partial) == record) return true;
    return describes(files, sidecar, partial);
  });
}

bool came_too_early(FileSystem& files, const std::string& sidecar, const std::string& volume, File& partial) {
  return placed_by_commit(files, sidecar, partial) && !describes(files, sidecar, volume);
}

bool is_committed(FileSystem& files, const std::string& output) {
  const std::string partial = partial_path(output);
  const std::string sidecar = sidecar_path(output);
  if (!files.exists(output)) return false;
  try {
    const std::string record = commit_record(short_text(files, sidecar));
    // Reads `partial` before files.open() locks it, because open() would create a missing file.
    if (short_text(files, partial) != record) return false;
    return short_text(*files.open(partial)) == record && describes(files, sidecar, output);
  } catch (const Error&) {
    return false;
  }
}

}  // namespace weir
