#include "format/output/commit_leftovers.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "format/base/error.h"
#include "format/io/digest.h"
#include "format/layout/nanovdb_layout.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

constexpr std::uint64_t kMostText = 64ULL << 20U;  // bytes of a sidecar; more is somebody else's file

std::string text_of(File& file) {
  const std::uint64_t bytes = file.size();
  if (bytes > kMostText) throw Error(ErrorKind::input, file.path() + ": is no sidecar");
  std::string text(bytes, '\0');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace

std::string commit_record(const std::string& sidecar_text) {
  return piece_digest(std::as_bytes(std::span(sidecar_text))).hex();
}

bool describes(FileSystem& files, const std::string& sidecar, File& volume) {
  try {
    if (!files.exists(sidecar)) return false;
    const Sidecar::File record = parse_sidecar(text_of(*files.open(sidecar)), sidecar).file;
    const std::uint64_t at = record.grid_offset + nvdb::grid::kChecksum;
    std::uint32_t checksum = 0;
    if (volume.size() != record.bytes || at + sizeof checksum > record.bytes) return false;
    volume.read_at(at, std::as_writable_bytes(std::span(&checksum, 1)));
    return checksum == record.head_checksum;
  } catch (const Error&) {
    return false;
  }
}

bool describes(FileSystem& files, const std::string& sidecar, const std::string& volume) {
  try {
    return files.exists(volume) && describes(files, sidecar, *files.open(volume));
  } catch (const Error&) {
    return false;
  }
}

bool belongs_back(FileSystem& files, const std::string& previous, const std::string& sidecar,
                  const std::string& volume) {
  return !describes(files, sidecar, volume) && describes(files, previous, volume);
}

bool placed_by_commit(FileSystem& files, const std::string& sidecar, File& partial) {
  try {
    const std::string text = text_of(*files.open(sidecar));
    const std::string record = commit_record(text);
    if (partial.size() == record.size() && text_of(partial) == record) return true;
  } catch (const Error&) {
    return false;
  }
  return describes(files, sidecar, partial);
}

bool is_committed(FileSystem& files, const std::string& output) {
  const std::string partial = output + ".partial";
  const std::string sidecar = sidecar_path(output);
  for (const std::string& path : {output, sidecar, partial}) {
    if (!files.exists(path)) return false;
  }
  try {
    const std::string record = commit_record(text_of(*files.open(sidecar)));
    const std::unique_ptr<File> lock = files.open(partial);
    return lock->size() == record.size() && text_of(*lock) == record;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace weir
