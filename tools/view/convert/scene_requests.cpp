#include "tools/view/convert/scene_requests.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "compressor/select/file_size.h"
#include "format/base/error.h"
#include "format/sidecar/read_sidecar.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

Sidecar sidecar_of(const NvdbFile& file, const std::string& volume) {
  if (std::optional<Sidecar> sidecar = own_sidecar(file)) return *std::move(sidecar);
  throw input_error(volume, "has no certificate of its own beside it, which would name its source; convert it again");
}

}  // namespace

SceneRequests::SceneRequests(boost::asio::io_context& io, SceneRequestRules rules, OpenFiles& files, Send send)
    : rules_(std::move(rules)),
      files_(files),
      send_(std::move(send)),
      converter_(io, rules_.program),
      forecasts_(io, rules_.program, rules_.forecast_options, send_) {}

void SceneRequests::handle(ViewerId viewer, std::size_t step, const std::string& volume,
                           const ConvertRequest& request) {
  Json reply{{"type", "conversion"}, {"id", request.id}, {"step", step}, {"command", nullptr}, {"bytes", nullptr}};
  const auto tell = [send = send_, viewer](Json told, const std::string& state, const std::string& message) {
    told["state"] = state;
    told["message"] = message;
    send(viewer, told);
  };
  SceneConversion conversion;
  try {
    const Sidecar sidecar = sidecar_of(*files_.get(volume), volume);
    conversion = scene_conversion(volume, rules_.preview_of, sidecar, request);
    reply["command"] = conversion.text;
    if (request.rate) reply["bytes"] = bytes_at_rate(sidecar.budget.dense_float32_bytes, *request.rate);
  } catch (const std::exception& error) {
    return tell(reply, "failed", error.what());
  }
  if (!request.run) {
    tell(reply, "shown", "");
    return forecast(viewer, conversion, request);
  }
  if (!rules_.run) return tell(reply, "failed", "this server runs no conversion; start it with --allow-convert");
  try {
    converter_.start(conversion, request.scene_text,
                     [tell, reply](const std::string& output, const std::string& message) {
                       tell(reply, message.empty() ? "done" : "failed", message.empty() ? output : message);
                     });
  } catch (const Error& error) {
    return tell(reply, "failed", error.what());
  }
  tell(reply, "running", "");
}

void SceneRequests::forecast(ViewerId viewer, const SceneConversion& conversion, const ConvertRequest& request) {
  if (rules_.forecast) return forecasts_.ask(viewer, request.id, conversion, request.scene_text);
  send_(viewer,
        {{"type", "forecast"},
         {"id", request.id},
         {"state", "failed"},
         {"message",
          "no memory is set aside for a forecast here, run the command with --dry-run; --forecast-memory of weir "
          "view, or 192 MiB of viewer_memory of weir watch, has one made"}});
}

}  // namespace weir
