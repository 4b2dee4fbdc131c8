#include "bindings/mpi/agreement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compressor/conversion_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/input_file.h"
#include "ingest/source/stored_value.h"

namespace weir {
namespace {

// Packs names and values, each ended by a zero byte.
std::string packed(const ConversionIdentity& said) {
  std::string text;
  for (const auto& [name, value] : said) text += cat(name, '\0', value, '\0');
  return text;
}

ConversionIdentity unpacked(const std::string& text) {
  const std::vector<std::string> words = split(text, '\0');
  ConversionIdentity said;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) said[words[i]] = words[i + 1];
  return said;
}

// Returns the value of `name` in `said` for a message: "--rate 4", or "no --rate".
std::string saying(const ConversionIdentity& said, const std::string& name) {
  const auto found = said.find(name);
  return found == said.end() || found->second.empty() ? cat("no ", name) : cat(name, ' ', found->second);
}

std::string three(const std::array<double, 3>& values) {
  return cat(stored_value_text(values[0]), ',', stored_value_text(values[1]), ',', stored_value_text(values[2]));
}

}  // namespace

ConversionIdentity said_by_all(const SourceInfo& info, const ConversionOptions& options) {
  ConversionIdentity said = identify_conversion(info, options);
  for (const char* name : {"source", "source modified (ns)", "source files", "source states"}) said.erase(name);
  said["spacing"] = three(info.spacing);
  said["origin"] = three(info.origin);
  if (options.scene) said["scene of digest"] = scene_digest(options.scene->scene);
  said["scale"] = stored_value_text(info.mapping.scale);
  said["offset"] = stored_value_text(info.mapping.offset);
  said["output"] = options.output;
  said["certify"] = options.certify == Certify::gradient ? "gradient" : "values";
  said["--overwrite"] = options.overwrite ? "on" : "";
  said["--work-dir"] = options.work_dir;
  return said;
}

Digest sampled_bytes(std::span<const FileState> files) {
  constexpr std::size_t kMostFiles = 64;
  constexpr std::uint64_t kPieces = 16;
  constexpr std::uint64_t kPieceBytes = 4096;
  DigestStream pieces;
  for (const FileState& state : files.first(std::min(files.size(), kMostFiles))) {
    if (state.bytes == 0) continue;  // empty or missing
    InputFile file(state.path, DirectIo::off);
    std::vector<std::byte> piece(std::min(kPieceBytes, state.bytes));
    for (std::uint64_t i = 0; i < kPieces; ++i) {
      file.read_buffered(i * (state.bytes - piece.size()) / (kPieces - 1), piece, ReadPath::cache);
      pieces.update(piece_digest(piece));
    }
  }
  return pieces.digest();
}

void require_alike(Team& team, const std::string& where, const ConversionIdentity& said) {
  const std::string own = packed(said);
  std::vector<char> leading(own.begin(), own.end());
  team.follow(leading);
  team.run([&] {
    const std::string text(leading.begin(), leading.end());
    if (text == own) return;
    const ConversionIdentity theirs = unpacked(text);
    ConversionIdentity all = said;
    all.insert(theirs.begin(), theirs.end());
    const auto differs = [&](const auto& entry) { return saying(said, entry.first) != saying(theirs, entry.first); };
    const auto first = std::find_if(all.begin(), all.end(), differs);
    if (first == all.end()) return;
    throw Error(ErrorKind::usage, cat(where, ": process ", team.rank(), " of ", team.size(), " has ",
                                      saying(said, first->first), " where process 0 has ", saying(theirs, first->first),
                                      "; give all processes the same volume, options and output"));
  });
}

}  // namespace weir
