#include "compressor/resume/checkpoint.h"

#include <nlohmann/json.hpp>
#include <span>

#include "compressor/survey/json_bits.h"
#include "compressor/survey/tally_json.h"
#include "format/base/json_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

using Json = nlohmann::json;

/// Raise the number whenever the meaning of a checkpoint or of one of its files changes.
constexpr std::string_view kFormat = "weir checkpoint 8 ";

Json to_json(const BoxSet& set) {
  Json boxes = Json::array();
  for (const Box& b : set.boxes()) boxes.push_back({b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z});
  return boxes;
}

BoxSet boxes_of(const Json& json) {
  BoxSet set;
  for (const Json& b : json) {
    const auto at = [&](std::size_t i) { return b.at(i).get<std::int64_t>(); };
    set.add({{at(0), at(1), at(2)}, {at(3), at(4), at(5)}});
  }
  return set;
}

Checkpoint checkpoint_of(const Json& json) {
  Checkpoint c;
  json.at("identity").get_to(c.identity);
  json.at("spill_directory").get_to(c.spill_directory);
  json.at("files").get_to(c.files);
  c.survey = {tally_of(json.at("tally")), boxes_of(json.at("surveyed"))};
  for (std::size_t i = 0; i < c.plan.bytes.size(); ++i) {
    c.plan.bytes[i] = static_cast<std::byte>(json.at("plan").at(i).get<unsigned>());
  }
  c.encoded.done = boxes_of(json.at("encoded"));
  c.encoded.sums = {json.at("encoded_sums").at("volume").get<std::uint64_t>(),
                    json.at("encoded_sums").at("records").get<std::uint64_t>()};
  if (json.contains("background")) {
    const Json& found = json["background"];
    c.background = {float_of(found.at("value")), found.at("method").get<std::string>(), double_of(found.at("share"))};
  }
  const Json& ladders = json.at("ladders");
  ladders.at("decided").get_to(c.ladders.decided);
  c.ladders.near = static_cast<NearBlocks>(ladders.at("near").get<int>());
  if (ladders.contains("centre")) {
    c.ladders.centre = double_of(ladders["centre"]);
    c.ladders.reach = double_of(ladders.at("reach"));
    c.ladders.width = float_of(ladders.at("width"));
  }
  ladders.at("short_of_preview").get_to(c.ladders.short_of_preview);
  ladders.at("built").get_to(c.ladders.built);
  ladders.at("rebuilt").get_to(c.ladders.rebuilt);
  ladders.at("moves").get_to(c.ladders.moves);
  if (json.contains("attempt")) {
    const Json& attempt = json["attempt"];
    c.attempt = {attempt.at("number").get<int>(), double_of(attempt.at("planned_error")),
                 static_cast<Encoding>(attempt.at("encoding").get<int>()), attempt.at("seen").get<std::string>()};
    if (attempt.contains("met")) c.attempt->met = double_of(attempt["met"]);
  }
  return c;
}

Digest digest_of(std::string_view text) { return piece_digest(std::as_bytes(std::span(text))); }

}  // namespace

std::string to_text(const Checkpoint& c) {
  Json json{{"identity", c.identity},
            {"spill_directory", c.spill_directory},
            {"files", c.files},
            {"surveyed", to_json(c.survey.done)},
            {"tally", tally_json(c.survey.tally)},
            {"ladders",
             {{"decided", c.ladders.decided},
              {"near", static_cast<int>(c.ladders.near)},
              {"short_of_preview", c.ladders.short_of_preview},
              {"built", c.ladders.built},
              {"rebuilt", c.ladders.rebuilt},
              {"moves", c.ladders.moves}}},
            {"plan", c.plan.bytes},
            {"encoded", to_json(c.encoded.done)},
            {"encoded_sums", {{"volume", c.encoded.sums.volume}, {"records", c.encoded.sums.records}}}};
  if (c.background) {
    json["background"] = {
        {"value", bits(c.background->value)}, {"method", c.background->method}, {"share", bits(c.background->share)}};
  }
  if (c.ladders.centre) {
    json["ladders"]["centre"] = bits(*c.ladders.centre);
    json["ladders"]["reach"] = bits(c.ladders.reach);
    json["ladders"]["width"] = bits(c.ladders.width);
  }
  if (c.attempt) {
    json["attempt"] = {{"number", c.attempt->number},
                       {"planned_error", bits(c.attempt->planned_error)},
                       {"encoding", static_cast<int>(c.attempt->encoding)},
                       {"seen", c.attempt->seen}};
    if (c.attempt->met) json["attempt"]["met"] = bits(*c.attempt->met);
  }
  // A path may hold any byte.
  const std::string body = json_text(json);
  return cat(kFormat, digest_of(body).hex(), '\n', body);
}

std::optional<Checkpoint> parse_checkpoint(std::string_view text) {
  constexpr std::size_t kDigits = 32;
  const std::size_t head = kFormat.size() + kDigits + 1;
  if (!text.starts_with(kFormat) || text.size() < head || text[head - 1] != '\n') return std::nullopt;
  const std::string_view body = text.substr(head);
  if (text.substr(kFormat.size(), kDigits) != digest_of(body).hex()) return std::nullopt;
  try {
    return checkpoint_of(Json::parse(body));
  } catch (const std::exception&) {
    return std::nullopt;  // the digest is right, but to_text() did not write this
  }
}

}  // namespace weir
