#include "tools/view/convert/scene_converter.h"

#include <utility>
#include <vector>

#include "daemon/jobs/worker_process.h"
#include "daemon/jobs/worker_reason.h"
#include "format/base/error.h"

namespace weir {

SceneConverter::SceneConverter(boost::asio::io_context& io, std::string program)
    : io_(io), program_(std::move(program)) {}

SceneConverter::~SceneConverter() = default;

void SceneConverter::start(const SceneConversion& conversion, const std::string& scene_text, Ended ended) {
  if (running()) throw Error(ErrorKind::usage, "a conversion runs already; wait for its end");
  std::vector<std::string> arguments = conversion_command(conversion, kept_scene_.write(scene_text));
  arguments.insert(arguments.end(), {"--progress", "never"});
  worker_ = std::make_unique<WorkerProcess>(
      io_, WorkerCommand{program_, arguments, 5, IoClass::none}, [](std::string_view) {},
      [this, output = conversion.output, ended = std::move(ended)](const WorkerEnd& end) mutable {
        const std::string path = std::move(output);  // moved out first: the captures may be destroyed with the worker
        const Ended tell = std::move(ended);
        const std::string message = end.exit_code == 0 ? "" : worker_reason("convert", end);
        worker_.reset();
        tell(path, message);
      });
}

}  // namespace weir
