#include "tools/sweep/sweep_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "format/base/exact_text.h"
#include "format/base/json_text.h"
#include "format/base/text.h"
#include "tools/report/error_text.h"
#include "tools/report/json_loss.h"

namespace weir {
namespace {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result;
  for (const char c : text) result.append(c == '"' ? 2 : 1, c);
  return cat('"', result, '"');
}

std::string joined(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    line += csv_field(field);
    line += &field == &fields.back() ? '\n' : ',';
  }
  return line;
}

std::string decibel_text(const Certificate& error) {
  return error.lossless ? "lossless" : error.psnr_db ? fixed(*error.psnr_db, 2) : "-";
}

std::vector<std::string> table_fields(const SweepReport& report, const SweepRow& row) {
  std::vector<std::string> fields{row.method, short_number(row.rate), cat(row.bytes_asked)};
  if (row.result) {
    const SweepResult& r = *row.result;
    for (const std::string& field :
         {cat(r.bytes), short_number(report.bits_per_voxel(r)), r.encoding, decibel_text(r.error),
          short_number(r.error.mse), short_number(r.error.max_abs), short_number(r.seconds),
          short_number(report.gb_per_s(r)), r.leaves_kept ? cat(*r.leaves_kept) : "-"}) {
      fields.push_back(field);
    }
  }
  return fields;
}

}  // namespace

std::string loss_note(const SweepResult& result) {
  const bool small = result.loss.max_abs_error <= 0.01 * result.error.max_abs;
  return result.loss.overflow == 0 && small ? "" : rounded_text(result.loss);
}

std::string csv_text(const SweepReport& report) {
  std::string text =
      "method,encoding,rate,bytes_asked,bytes_got,bits_per_voxel,mse,nmse,psnr_db,max_abs,lossless,seconds,gb_per_s,"
      "leaves_kept,note\n";
  for (const SweepRow& row : report.rows) {
    if (!row.result) {
      text += joined({row.method, "", exact_text(row.rate), cat(row.bytes_asked), "", "", "", "", "", "", "", "", "",
                      "", row.note});
      continue;
    }
    const SweepResult& r = *row.result;
    text += joined({row.method, r.encoding, exact_text(row.rate), cat(row.bytes_asked), cat(r.bytes),
                    exact_text(report.bits_per_voxel(r)), exact_text(r.error.mse), exact_text(r.error.nmse),
                    r.error.psnr_db ? exact_text(*r.error.psnr_db) : "", exact_text(r.error.max_abs),
                    r.error.lossless ? "true" : "false", exact_text(r.seconds), exact_text(report.gb_per_s(r)),
                    r.leaves_kept ? cat(*r.leaves_kept) : "", row.note});
  }
  return text;
}

std::string json_text(const SweepReport& report) {
  using Json = nlohmann::ordered_json;
  const auto optional = [](const auto& value) { return value ? Json(*value) : Json(); };
  Json rows = Json::array();
  for (const SweepRow& row : report.rows) {
    Json json{{"method", row.method}, {"rate", row.rate}, {"bytes_asked", row.bytes_asked}};
    if (row.result) {
      const SweepResult& r = *row.result;
      json["encoding"] = r.encoding;
      json["bytes_got"] = r.bytes;
      json["bits_per_voxel"] = report.bits_per_voxel(r);
      json["mse"] = r.error.mse;
      json["nmse"] = r.error.nmse;
      json["psnr_db"] = optional(r.error.psnr_db);
      json["max_abs"] = r.error.max_abs;
      json["lossless"] = r.error.lossless;
      json["seconds"] = r.seconds;
      json["gb_per_s"] = report.gb_per_s(r);
      json["leaves_kept"] = optional(r.leaves_kept);
      json["conversion_loss"] = loss_json(r.loss);
    } else {
      for (const char* key : {"encoding", "bytes_got", "bits_per_voxel", "mse", "nmse", "psnr_db", "max_abs",
                              "lossless", "seconds", "gb_per_s", "leaves_kept", "conversion_loss"}) {
        json[key] = nullptr;
      }
    }
    json["note"] = row.note;
    rows.push_back(std::move(json));
  }
  const Json document{{"source", report.source},
                      {"extent", {report.extent.x, report.extent.y, report.extent.z}},
                      {"dense_float32_bytes", static_cast<std::uint64_t>(volume(report.extent)) * sizeof(float)},
                      {"threads", report.threads},
                      {"memory_bytes", report.memory},
                      {"rows", std::move(rows)},
                      {"total_s", report.total_s},
                      {"peak_rss_bytes", report.peak_rss_bytes}};
  return json_text(document, 2) + '\n';
}

std::string table_text(const SweepReport& report) {
  std::vector<std::vector<std::string>> lines{{"method", "rate", "bytes asked", "bytes got", "bits/voxel", "stored as",
                                               "PSNR dB", "MSE", "max error", "seconds", "GB/s", "leaves"}};
  for (const SweepRow& row : report.rows) lines.push_back(table_fields(report, row));
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t i = 0; i < lines[n].size(); ++i) {
      const std::string gap(widths[i] - lines[n][i].size(), ' ');
      text += i == 0 ? cat(lines[n][i], gap) : cat("  ", gap, lines[n][i]);  // the name is aligned left, numbers right
    }
    if (n > 0 && !report.rows[n - 1].result) text += cat("  ", report.rows[n - 1].note);
    text += '\n';
  }
  return text;
}

}  // namespace weir
