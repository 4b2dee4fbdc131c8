// Answers what pages ask about the conversion for a scene: its command, its forecast, and its run. Lives on the
// io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/view/base/open_files.h"
#include "tools/view/base/view_message.h"
#include "tools/view/convert/scene_converter.h"
#include "tools/view/convert/scene_forecasts.h"

namespace weir {

struct SceneRequestRules {
  std::string program;     ///< path of weir
  std::string preview_of;  ///< the source of which the volume is a preview; empty: the sidecar names the source
  bool run = false;        ///< a page may run the conversion
  bool forecast = true;    ///< a page may ask for a forecast, which takes the memory of a conversion
  std::vector<std::string> forecast_options = {};  ///< options of weir convert that limit a forecast's resources
};

class SceneRequests {
 public:
  using Send = std::function<void(ViewerId viewer, const nlohmann::ordered_json& message)>;

  /// `files` must outlive the object.
  SceneRequests(boost::asio::io_context& io, SceneRequestRules rules, OpenFiles& files, Send send);

  /// Answers by `send`, now and again as more is known, for the volume of `step`. If there is no command because the
  /// sidecar or the source is missing, the answer has none.
  void handle(ViewerId viewer, std::size_t step, const std::string& volume, const ConvertRequest& request);
  /// Drops the questions of a viewer that has gone.
  void forget(ViewerId viewer) { forecasts_.forget(viewer); }

 private:
  void forecast(ViewerId viewer, const SceneConversion& conversion, const ConvertRequest& request);

  const SceneRequestRules rules_;
  OpenFiles& files_;
  const Send send_;
  SceneConverter converter_;
  SceneForecasts forecasts_;
};

}  // namespace weir
