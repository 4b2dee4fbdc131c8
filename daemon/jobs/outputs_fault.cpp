#include "daemon/jobs/outputs_fault.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

// Returns which loss the recorded error does not cover: values that became infinite in float32, or values that were
// rounded although the output is called lossless. Empty if there is none.
std::string loss_fault(const nlohmann::json& sidecar, const std::string& path) {
  const auto member = [](const nlohmann::json& of, const char* key) {
    return of.is_object() ? of.value(key, nlohmann::json()) : nlohmann::json();
  };
  const nlohmann::json loss = member(sidecar, "conversion_loss");
  const auto count = [&](const char* key) {
    const nlohmann::json value = member(loss, key);
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
  };
  const std::uint64_t overflow = count("overflow");
  if (overflow > 0)
    return cat(path, ": ", overflow, overflow == 1 ? " value is" : " values are", " infinite in float32");
  const std::uint64_t inexact = count("inexact");
  if (inexact == 0 || member(member(sidecar, "error"), "lossless") != true) return {};
  return cat(path, ": ", inexact, inexact == 1 ? " value was" : " values were",
             " rounded to float32, so the output is not lossless");
}

// Returns the content of the certificate at `path`; null if it cannot be read.
nlohmann::json read_certificate(const std::string& path) {
  std::ifstream file(path);
  nlohmann::json sidecar = nlohmann::json::parse(file, nullptr, false);
  const bool whole = sidecar.is_object() && sidecar.contains("source") && sidecar["source"].is_object();
  return whole ? std::move(sidecar) : nlohmann::json();
}

// Returns whether the certificate has the figures that the job recorded for the output. Another volume of the same
// size has other figures.
bool is_of_output(const nlohmann::json& sidecar, const JobOutput& output) {
  const auto is = [&](const char* place, const std::optional<double>& expected) {
    const nlohmann::json::json_pointer pointer(place);
    if (!expected || !std::isfinite(*expected) || !sidecar.contains(pointer)) return true;
    return sidecar[pointer] == *expected;
  };
  return is("/value_range/0", output.min) && is("/value_range/1", output.max) &&
         is("/error/max_abs", output.max_error) && is("/error/psnr_db", output.psnr_db);
}

// Returns why `sidecar`, read from `path`, is not the certificate of the job's source in its present `state`; empty
// if it is.
std::string certificate_fault(const Job& job, const nlohmann::json& sidecar, const std::string& path,
                              const std::optional<FileState>& state) {
  const nlohmann::json& source = sidecar["source"];
  if (source.contains("files_digest")) return "its values lie in several files, which other headers may name";
  const auto is = [&](const char* key, const nlohmann::json& value) {
    return source.contains(key) && source[key] == value;
  };
  if (!is("path", job.source) || !is("bytes", job.identity.bytes) || !is("mtime", utc_text(job.identity.mtime_ns))) {
    return cat(path, " is of another file, or of this one as it was before");
  }
  if (state && touched_since(*state, look_at_file(path))) {
    return cat("it was replaced, or its name, rights, owner or links were changed, after ", path,
               " was written; let its job be done again (weir retry --force ", job.id, ")");
  }
  return loss_fault(sidecar, path);
}

// Returns whether the volume was written after its certificate. A conversion completes the volume first.
bool written_since_certified(const std::string& path) {
  const std::int64_t certified = look_at_file(sidecar_path(path)).mtime_ns;
  return look_at_file(path).mtime_ns > certified + tick_of(certified);
}

// Returns the number of voxels of the converted volume.
std::uint64_t voxels_of(const nlohmann::json& source) {
  const nlohmann::json extent = source.value("extent", nlohmann::json());
  std::uint64_t voxels = extent.is_array() ? 1 : 0;
  for (const nlohmann::json& axis : extent) voxels *= axis.is_number_unsigned() ? axis.get<std::uint64_t>() : 0;
  return voxels;
}

// Returns the number of values in the source file; 0: not known. If the count is missing, a raw file's size gives it.
std::uint64_t values_of(const nlohmann::json& source) {
  const auto number = [&](const char* key) {
    const nlohmann::json value = source.value(key, nlohmann::json());
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
  };
  const nlohmann::json type = source.value("type", nlohmann::json());
  if (const std::uint64_t counted = number("values"); counted > 0) return counted;
  const auto scalar = type.is_string() ? parse_scalar(type.get<std::string>()) : std::nullopt;
  return scalar && source.value("format", nlohmann::json()) == "raw" ? number("bytes") / scalar_bytes(*scalar) : 0;
}

}  // namespace

std::string outputs_fault(const Job& job, const std::optional<FileState>& state) {
  if (job.result.outputs.empty()) return "it has no outputs";
  std::uint64_t voxels = 0;  // of all outputs
  std::uint64_t values = 0;  // of the source
  for (const JobOutput& output : job.result.outputs) {
    std::error_code error;
    if (fs::file_size(output.path, error) != output.bytes || error) return cat(output.path, " is not there as it was");
    const std::string path = sidecar_path(output.path);
    if (!fs::is_regular_file(path, error)) return cat(path, " is not there");
    const nlohmann::json sidecar = read_certificate(path);
    if (sidecar.is_null()) return cat(path, " cannot be read");
    if (std::string fault = certificate_fault(job, sidecar, path, state); !fault.empty()) return fault;
    if (!is_of_output(sidecar, output)) return cat(path, " is of another volume than the job's");
    if (written_since_certified(output.path)) {
      return cat(output.path, " was written to after its certificate; let its job be done again (weir retry --force ",
                 job.id, ")");
    }
    const std::uint64_t counted = values_of(sidecar["source"]);
    if (counted == 0) {
      return cat(path, " does not say what else the file holds; let its job be done again (weir retry --force ", job.id,
                 ")");
    }
    values = counted;
    voxels += voxels_of(sidecar["source"]);
  }
  if (voxels >= values) return {};
  return cat("its outputs have ", voxels, " of the ", values,
             " values in it, and what else it holds would go with it; keep sources, or write that to another file");
}

}  // namespace weir
