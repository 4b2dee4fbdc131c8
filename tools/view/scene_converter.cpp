#include "tools/view/scene_converter.h"

#include <cerrno>
#include <fstream>
#include <utility>

#include "daemon/jobs/worker_process.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The last line of what the program said: its error.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

SceneConverter::SceneConverter(boost::asio::io_context& io, std::string program)
    : io_(io), program_(std::move(program)) {}

SceneConverter::~SceneConverter() = default;

void SceneConverter::start(SceneConversion conversion, const std::string& scene_text, Ended ended) {
  if (running()) throw Error(ErrorKind::usage, "a conversion runs already; wait for its end");
  if (!folder_) folder_.emplace();
  const std::string scene = (folder_->path() / "scene.toml").string();
  std::ofstream file(scene, std::ios::binary | std::ios::trunc);
  file << scene_text;
  file.close();
  if (!file) throw io_error(scene, "write the scene", errno);
  conversion.arguments.back() = scene;
  conversion.arguments.insert(conversion.arguments.begin(), "weir");
  conversion.arguments.insert(conversion.arguments.end(), {"--progress", "never"});
  worker_ = std::make_unique<WorkerProcess>(
      io_, WorkerCommand{program_, conversion.arguments, 5, IoClass::none}, [](std::string_view) {},
      [this, output = conversion.output, ended = std::move(ended)](const WorkerEnd& end) {
        const std::string path = output;  // what is captured may go with the worker
        const Ended tell = ended;
        const std::string message = end.exit_code == 0 ? "" : last_line(end.log);
        worker_.reset();
        tell(path, message);
      });
}

}  // namespace weir
