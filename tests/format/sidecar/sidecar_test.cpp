#include "format/sidecar/sidecar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/support/temporary_directory.h"

namespace weir::sidecar_test {
namespace {

// Every member differs from its default and from its neighbours.
Sidecar sample() {
  Sidecar s;
  s.source = {"in/a.nc",
              "hdf5",
              "/fields/a b",
              {64, 65, 66},
              "uint8",
              262144,
              "2026-11-21T01:39:00.123456789Z",
              "0123456789abcdef0123456789abcdef",
              {3, 1},
              {"x", "y", "height"},
              "kg m-3",
              1e-4,
              0.5,
              -2,
              "00112233445566778899aabbccddeeff",
              "cloud water",
              "magnitude",
              Sidecar::Level{1, 4},
              Sidecar::Time{1200, "seconds since 2000-01-01", "noleap"},
              {"km", "", "m"},
              Sidecar::IrregularAxes{{}, {}, {0.1, 0.3, 0.6}},
              {"y"},
              "axes along +z, -x, +y of the file's world",
              "1 of its 3 chunks is not stored and reads as its fill value, 7",
              12,
              "/data/in/a.nc"};
  s.grid = {"density", "float32", {60, 61, 62}, {0.1, 0.2, 0.3}, {-1, 1e300, 5e-324}, {{-4, 5, 6}, {56, 66, 68}}};
  s.value_range = {-0.1, 1.0 / 3.0};
  s.nonfinite = {18446744073709551615U, "keep"};
  s.missing = {7, {"-9999", "nan"}, "background"};
  s.conversion_loss = {3, 4, 0.5};
  s.zeros = Sidecar::Zeros{123, 45};
  s.background = {0.25, "mode", 0.9899};
  s.histogram = {-1, 2, {1, 0, 9007199254740993U}};
  s.budget = {"size", 1048576, 1048576, 1048592, 1.0000152587890625};
  s.selection = {"sse", "mean", 16, 512, 100, {1, 2, 3, 4, 5, 85}, {}};
  s.error = {1e-6, 1e-3, 2e-6, 60.5, 0.125, false};
  s.gradient = Sidecar::GradientError{0.375, 1.0 / 7.0, 8.5, 246, 14};
  s.visible = Sidecar::Visible{
      "bone.toml", 77, 39424, {0.75, 0.875, 0.0625, 21.5, 4.5, false}, "ffeeddccbbaa99887766554433221100"};
  s.macrocells = {16, {4, 5, 6}, 1};
  s.timing = {1.5, 2.5, 4.25, 1, 2, 3};
  s.file = {1048576, 4096, 0x0badc0deU, "fedcba9876543210fedcba9876543210"};
  s.weir = {"0.1.0", "abc1234", {{"rate", "8"}, {"memory", "512MiB"}}};
  return s;
}

std::string message(const std::string& text) {
  try {
    parse_sidecar(text, "a.nvdb.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

std::string edited(const std::function<void(nlohmann::json&)>& edit) {
  auto document = nlohmann::json::parse(to_json_text(sample()));
  edit(document);
  return document.dump();
}

TEST(Sidecar, ReadsBackWhatWasWritten) {
  const std::string text = to_json_text(sample());
  const Sidecar read = parse_sidecar(text, "a.nvdb.json");
  EXPECT_EQ(to_json_text(read), text);
  EXPECT_EQ(read.grid.origin, sample().grid.origin);
  EXPECT_EQ(read.grid.index_bbox, sample().grid.index_bbox);
  EXPECT_EQ(read.value_range, sample().value_range);
  EXPECT_EQ(read.nonfinite.count, 18446744073709551615U);
  EXPECT_EQ(read.histogram.counts, sample().histogram.counts);
  EXPECT_EQ(read.file.head_checksum, 0x0badc0deU);
  EXPECT_EQ(read.weir.options, sample().weir.options);
}

TEST(Sidecar, WritesOneKeyPerLineInTheDocumentedOrder) {
  std::istringstream lines(to_json_text(sample()));
  std::string keys;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > 3) keys += line.substr(3, line.find('"', 3) - 3) + ' ';
  }
  EXPECT_EQ(keys,
            "weir_sidecar source grid value_range nonfinite missing conversion_loss zeros background histogram budget "
            "selection "
            "error visible macrocells timing file weir ");
}

TEST(Sidecar, NonFiniteValuesAreNullAndReadAsNaN) {
  Sidecar s = sample();
  s.error.nmse = std::numeric_limits<double>::quiet_NaN();
  s.error.max_abs = std::numeric_limits<double>::infinity();
  s.error.psnr_db.reset();
  s.budget.requested.reset();
  s.value_range = {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()};
  const std::string text = to_json_text(s);
  const auto document = nlohmann::json::parse(text);
  EXPECT_TRUE(document["error"]["nmse"].is_null());
  EXPECT_TRUE(document["error"]["max_abs"].is_null());
  EXPECT_TRUE(document["error"]["psnr_db"].is_null());
  const Sidecar read = parse_sidecar(text, "a.nvdb.json");
  EXPECT_TRUE(std::isnan(read.error.nmse));
  EXPECT_TRUE(std::isnan(read.value_range[1]));
  EXPECT_FALSE(read.error.psnr_db.has_value());
  EXPECT_FALSE(read.budget.requested.has_value());
}

TEST(Sidecar, PathsThatAreNotUtf8StayValidJson) {
  Sidecar s = sample();
  s.source.path = "in/\xff\xfe\n\".raw";
  EXPECT_EQ(parse_sidecar(to_json_text(s), "a.nvdb.json").source.path, "in/\xEF\xBF\xBD\xEF\xBF\xBD\n\".raw");
}

TEST(Sidecar, ErrorsNameTheKey) {
  const std::string remedy = "; write the sidecar again with weir convert";
  EXPECT_EQ(message(""), "a.nvdb.json: at byte 0: not valid JSON" + remedy);
  EXPECT_EQ(message("{\"weir_sidecar\": 1"), "a.nvdb.json: at byte 18: not valid JSON" + remedy);
  EXPECT_EQ(message("[1]"), "a.nvdb.json: not a JSON object; give the sidecar of a volume");
  EXPECT_EQ(message("{}"), "a.nvdb.json: key weir_sidecar is missing" + remedy);
  EXPECT_EQ(message("{\"weir_sidecar\": 2}"),
            "a.nvdb.json: key weir_sidecar: version 2, but this weir reads version 1; use the weir that wrote it");
  EXPECT_EQ(message(edited([](auto& d) { d["source"].erase("mtime"); })),
            "a.nvdb.json: key source.mtime is missing" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["selection"]["bits"].erase("16"); })),
            "a.nvdb.json: key selection.bits.16 is missing" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["file"] = 7; })),
            "a.nvdb.json: key file: expected an object, found 7" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["file"]["bytes"] = -1; })),
            "a.nvdb.json: key file.bytes: expected a whole number, not negative, found -1" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["file"]["bytes"] = 1.5; })),
            "a.nvdb.json: key file.bytes: expected a whole number, not negative, found 1.5" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["file"]["head_checksum"] = "0BADC0DE"; })),
            "a.nvdb.json: key file.head_checksum: expected 8 lower-case hex digits, found \"0BADC0DE\"" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["error"]["lossless"] = "no"; })),
            "a.nvdb.json: key error.lossless: expected true or false, found \"no\"" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["histogram"]["counts"][1] = "x"; })),
            "a.nvdb.json: key histogram.counts[1]: expected a whole number, not negative, found \"x\"" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["value_range"].push_back(1); })),
            "a.nvdb.json: key value_range: expected an array of 2, found an array of 3" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["grid"]["index_bbox"][1][2] = 18446744073709551615U; })),
            "a.nvdb.json: key grid.index_bbox[1][2]: expected a whole number, found 18446744073709551615" + remedy);
  EXPECT_EQ(message(edited([](auto& d) { d["weir"]["options"]["rate"] = 8; })),
            "a.nvdb.json: key weir.options.rate: expected a string, found 8" + remedy);
}

TEST(Sidecar, NumbersBeyondDoubleAreRefused) {
  EXPECT_EQ(message("{\"weir_sidecar\": 1e999}"),
            "a.nvdb.json: a number is beyond the range of double; write the sidecar again with weir convert");
}

TEST(Sidecar, DeepNesting_IsRefusedBeforeItTakesMemory) {
  const std::string deep = "{\"weir_sidecar\": " + std::string(1000000, '[') + std::string(1000000, ']') + "}";
  EXPECT_EQ(message(deep),
            "a.nvdb.json: nested deeper than 16 levels, no sidecar is; write it again with weir convert");
  EXPECT_EQ(message("{\"weir_sidecar\": " + std::string(15, '[') + std::string(15, ']') + "}"),
            "a.nvdb.json: key weir_sidecar: expected a whole number, found an array of 1; write the sidecar again with "
            "weir convert");
}

TEST(Sidecar, KeysAbsentFromOlderSidecarsAreOptional) {
  const std::string older = edited([](auto& d) {
    d["source"].erase("files_digest");
    d["source"].erase("real_path");
    d["visible"].erase("scene_digest");
  });
  const Sidecar read = parse_sidecar(older, "a.nvdb.json");
  EXPECT_EQ(read.source.files_digest, "");
  EXPECT_EQ(read.source.real_path, "");
  EXPECT_EQ(read.visible->scene_digest, "");
  EXPECT_EQ(nlohmann::json::parse(to_json_text(read)), nlohmann::json::parse(older));
}

Sidecar packed_sample() {
  Sidecar s = sample();
  s.packed = Sidecar::Packed{true};
  s.selection.blocks = {332, 5, 100, 70, 5};
  s.error_preview = Sidecar::CertifiedError{0.5, 0.625, 0.03125, 15.5, 2.25, false};
  return s;
}

TEST(Sidecar, OfAPackedFile_HasTheErrorOfThePreviewAndTheBlocksByKind) {
  const std::string text = to_json_text(packed_sample());
  const auto document = nlohmann::json::parse(text);
  EXPECT_EQ(document["error_preview"].dump(),
            R"({"lossless":false,"max_abs":2.25,"mse":0.5,"nmse":0.03125,"psnr_db":15.5,"rmse":0.625})");
  EXPECT_EQ(document["selection"]["blocks"].dump(), R"({"lattice":70,"mean":5,"none":332,"raw":5,"transform":100})");
  EXPECT_EQ(to_json_text(parse_sidecar(text, "a.nvdb.json")), text);
  EXPECT_FALSE(nlohmann::json::parse(to_json_text(sample())).contains("error_preview"));
}

TEST(Sidecar, OfAPackedFile_ReadsBlocksAndPreviewFromWhereTheyWereBefore) {
  auto older = nlohmann::json::parse(to_json_text(packed_sample()));
  older["packed"]["blocks"] = older["selection"]["blocks"];
  older["packed"]["error_preview"] = older["error_preview"];
  older["selection"].erase("blocks");
  older.erase("error_preview");
  EXPECT_EQ(to_json_text(parse_sidecar(older.dump(), "a.nvdb.json")), to_json_text(packed_sample()));
}

TEST(Sidecar, IgnoresKeysItDoesNotKnow) {
  EXPECT_EQ(message(edited([](auto& d) { d["later"] = {1, 2}; })), "no error");
}

// 'y' or 'n' for each document; empty where python3 has no jsonschema.
std::string validate_against_schema(const std::vector<std::string>& documents) {
  const TemporaryDirectory directory;
  const std::string path = directory / "documents.jsonl";
  {
    std::ofstream out(path);
    for (const std::string& document : documents) out << nlohmann::json::parse(document).dump() << '\n';
  }
  const std::string command =
      "python3 -c 'import json,sys,jsonschema; s=json.load(open(sys.argv[1])); "
      "v=jsonschema.validators.validator_for(s); v.check_schema(s); v=v(s); "
      "print(\"\".join(\"y\" if v.is_valid(json.loads(l)) else \"n\" for l in open(sys.argv[2])))' '" +
      std::string(WEIR_SOURCE_DIR) + "/format/sidecar.schema.json' '" + path + "' 2>/dev/null";
  std::string answers;
  if (FILE* pipe = popen(command.c_str(), "r"); pipe != nullptr) {
    for (int c = std::fgetc(pipe); c != EOF && c != '\n'; c = std::fgetc(pipe)) answers += static_cast<char>(c);
    pclose(pipe);
  }
  return answers;
}

TEST(Sidecar, SchemaAcceptsTheSampleAndRejectsAMissingKey) {
  if (std::system("python3 -c 'import jsonschema' 2>/dev/null") != 0) {
    GTEST_SKIP() << "python3 with jsonschema is missing";
  }
  Sidecar lossless = sample();
  lossless.error = {0, 0, 0, std::nullopt, 0, true};
  lossless.budget.requested.reset();
  lossless.visible.reset();
  lossless.gradient.reset();
  lossless.source.files_digest.clear();
  std::vector<std::string> documents{to_json_text(sample()), to_json_text(lossless), to_json_text(packed_sample()),
                                     edited([](auto& d) { d["file"]["digest"] = "xyz"; }),
                                     edited([](auto& d) { d["selection"]["leaves_kept"] = -1; })};
  const auto document = nlohmann::json::parse(to_json_text(sample()));
  for (const auto& [key, value] : document.items()) {
    if (key == "visible" || key == "zeros") continue;  // there with a scene only; not in older sidecars
    documents.push_back(edited([k = key](auto& d) { d.erase(k); }));
  }
  EXPECT_EQ(validate_against_schema(documents), "yyy" + std::string(documents.size() - 3, 'n'));
}

TEST(Sidecar, PathIsTheVolumesWithJson) { EXPECT_EQ(sidecar_path("out/a.nvdb"), "out/a.nvdb.json"); }

TEST(Sidecar, UtcText) {
  EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(utc_text(951782400123456789), "2000-02-29T00:00:00.123456789Z");
  EXPECT_EQ(utc_text(-1), "1969-12-31T23:59:59.999999999Z");
}

}  // namespace
}  // namespace weir::sidecar_test
