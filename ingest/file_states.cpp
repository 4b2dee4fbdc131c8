#include "ingest/file_states.h"

#include <sys/stat.h>

#include <filesystem>
#include <span>

#include "format/text.h"

namespace weir {
namespace {

std::string time_text(const timespec& time) { return cat(time.tv_sec, ' ', time.tv_nsec); }

}  // namespace

void FileStates::add(const std::string& path, const std::string& named) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) status = {};
  // A name holds no zero byte.
  const std::string text = cat(std::filesystem::path(path).filename().string(), '\0', status.st_size, ' ',
                               time_text(status.st_mtim), ' ', time_text(status.st_ctim), ' ', named);
  states_.update(piece_digest(std::as_bytes(std::span(text))));
  files_ += named.empty() ? 1 : 2;
}

std::string FileStates::digest() const { return files_ < 2 ? std::string() : states_.digest().hex(); }

}  // namespace weir
