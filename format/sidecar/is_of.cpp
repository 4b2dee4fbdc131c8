#include "format/sidecar/is_of.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "format/base/error.h"
#include "format/io/digest.h"
#include "format/io/output_names.h"
#include "format/io/real_path.h"
#include "format/layout/nanovdb_layout.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/short_text.h"

namespace weir {
namespace {

bool have_one_head(const Sidecar::File& a, const Sidecar::File& b) {
  return a.bytes == b.bytes && a.head_checksum == b.head_checksum;
}

// Returns whether OUT.nvdb.partial is a volume with the head that `record` describes, or is the lock of a volume in
// another place and holds the digest of the sidecar at `sidecar`. While a conversion runs it is neither.
bool is_to_follow(FileSystem& files, const std::string& partial, const Sidecar::File& record,
                  const std::string& sidecar) {
  const std::unique_ptr<File> file = files.open_to_read(partial);
  if (file->size() != 2 * sizeof(Digest)) return has_head(record, *file);
  const std::string text = short_text(files, sidecar);
  return short_text(files, partial) == piece_digest(std::as_bytes(std::span(text))).hex();
}

// Returns whether a killed commit may have put the sidecar beside another volume with the same head. Files that cannot
// be read count as no evidence.
bool may_be_of_another(FileSystem& files, const std::string& path, const Sidecar::File& record) {
  const std::string sidecar = find_sidecar(path);
  const std::string previous = previous_path(sidecar);
  const std::string partial = partial_path(sidecar.substr(0, sidecar.size() - kSidecarEnding.size()));
  const auto holds = [](const auto& check) {
    try {
      return check();
    } catch (const Error&) {
      return false;
    }
  };
  return (is_there(previous) &&
          holds([&] { return have_one_head(parse_sidecar(short_text(files, previous), previous).file, record); })) ||
         (is_there(partial) && holds([&] { return is_to_follow(files, partial, record, sidecar); }));
}

}  // namespace

bool has_head(const Sidecar::File& record, File& volume) {
  constexpr std::uint64_t kHeadBytes = nvdb::grid::kChecksum + sizeof(std::uint32_t);
  if (volume.size() != record.bytes || record.grid_offset > record.bytes) return false;
  if (record.bytes - record.grid_offset < kHeadBytes) return false;
  std::uint32_t checksum = 0;
  volume.read_at(record.grid_offset + nvdb::grid::kChecksum, std::as_writable_bytes(std::span(&checksum, 1)));
  return checksum == record.head_checksum;
}

bool is_of(const Sidecar& sidecar, const NvdbGrid& grid) {
  return sidecar.file.bytes == grid.bytes().size() && sidecar.file.head_checksum == grid.head_checksum();
}

bool is_of(const Sidecar& sidecar, const NvdbFile& file) {
  if (!is_of(sidecar, file.grid())) return false;
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  if (!may_be_of_another(*files, file.path(), sidecar.file)) return true;
  // Reads the file instead of mapping it, because mapped pages count as the process's memory.
  return whole_digest(*files->open_to_read(file.path())).hex() == sidecar.file.digest;
}

}  // namespace weir
