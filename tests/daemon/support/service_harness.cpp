#include "tests/daemon/support/service_harness.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "tests/support/sanitized.h"

namespace weir {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

ServiceHarness::ServiceHarness(std::string service, std::string watch) {
  fs::create_directories(in());
  fs::create_directories(out());
  configure(service, watch);
}

ServiceHarness::~ServiceHarness() {
  if (process_) process_->send_signal(SIGKILL);
}

void ServiceHarness::configure(const std::string& service, const std::string& watch) {
  const auto unless = [](const std::string& keys, const std::string& key, const std::string& line) {
    return keys.find(key + " =") == std::string::npos ? line : "";
  };
  write_file(path("weir.toml"),
             cat("[service]\nlisten = \"127.0.0.1:0\"\nlog = \"log\"\n",
                 unless(service, "port_file", "port_file = \"port\"\n"), unless(service, "threads", "threads = 1\n"),
                 service, "\n[[watch]]\ndirectory = \"in\"\n", unless(watch, "output", "output = \"out\"\n"),
                 unless(watch, "settle", "settle = 0.3\n"), unless(watch, "poll_interval", "poll_interval = 0.1\n"),
                 unless(watch, "thumbnails", "thumbnails = false\n"), watch));
}

void ServiceHarness::run_unprivileged() {
  if (::geteuid() != 0) return;
  constexpr uid_t kNobody = 65534;
  for (const char* name : {".", "in", "out", "weir.toml"}) {
    if (::chown(path(name).c_str(), kNobody, kNobody) != 0) throw std::runtime_error("chown " + path(name));
  }
  launcher_ = {"setpriv", cat("--reuid=", kNobody), cat("--regid=", kNobody), "--clear-groups"};
}

void ServiceHarness::launch() {
  fs::remove(path("port"));
  CommandOptions options;
  options.timeout = std::chrono::minutes(10);
  std::vector<std::string> command = launcher_;
  command.insert(command.end(), {WEIR_COMMAND, "watch", path("weir.toml")});
  process_ = std::make_unique<ChildProcess>(command, options);
}

void ServiceHarness::start() {
  const std::size_t before = fs::exists(path("log")) ? logged(" ready ") : 0;
  launch();
  const bool ready = eventually([&] { return !running() || (fs::exists(path("log")) && logged(" ready ") > before); });
  if (!ready || !running()) {
    throw std::runtime_error("weir watch did not start: " + (running() ? log() : process_->wait().err));
  }
}

int ServiceHarness::wait(CommandResult* result) {
  CommandResult end = process_->wait();
  process_.reset();
  const int code = end.exit_code;
  if (result != nullptr) *result = std::move(end);
  return code;
}

int ServiceHarness::stop() {
  process_->send_signal(SIGTERM);
  return wait();
}

void ServiceHarness::kill() {
  process_->send_signal(SIGKILL);
  wait();
}

std::string ServiceHarness::volume(int seed) {
  std::string bytes(24 * 20 * 16, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<char>((i * i / 7 + i) * static_cast<std::size_t>(seed));
  return bytes;
}

std::string ServiceHarness::add(const std::string& stem, int seed) const {
  const std::string name = stem + kSuffix;
  write_file(in(name + ".raw"), volume(seed));
  return name;
}

int ServiceHarness::port() const {
  int port = 0;
  std::ifstream(path("port")) >> port;
  return port;
}

std::string ServiceHarness::request(const std::string& method, const std::string& target) const {
  const Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return "";
  const std::string text = cat(method, ' ', target, " HTTP/1.1\r\nHost: localhost\r\nX-Weir: test\r\n",
                               "Content-Length: 0\r\nConnection: close\r\n\r\n");
  ::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL);
  std::string answer;
  std::array<char, 4096> piece{};
  for (ssize_t n; (n = ::recv(socket.get(), piece.data(), piece.size(), 0)) > 0;) {
    answer.append(piece.data(), static_cast<std::size_t>(n));
  }
  const std::size_t body = answer.find("\r\n\r\n");
  return body == std::string::npos ? "" : answer.substr(body + 4);
}

ServiceHarness::Json ServiceHarness::get(const std::string& target) const {
  return Json::parse(request("GET", target), nullptr, false);
}

ServiceHarness::Json ServiceHarness::post(const std::string& target) const {
  return Json::parse(request("POST", target), nullptr, false);
}

std::uint64_t ServiceHarness::count(const std::string& state) const {
  const Json page = get("/api/jobs?limit=1&state=" + state);
  return page.is_object() ? page.value("total", std::uint64_t{0}) : 0;
}

ServiceHarness::Json ServiceHarness::job(const std::string& name) const {
  const Json page = get("/api/jobs?limit=1000");
  if (!page.is_object()) return Json::object();
  for (const Json& job : page["jobs"]) {
    if (job["source"] == in(name)) return job;
  }
  return Json::object();
}

std::string ServiceHarness::log() const { return fs::exists(path("log")) ? read_file(path("log")) : ""; }

std::size_t ServiceHarness::logged(const std::string& text) const {
  std::size_t count = 0;
  const std::string all = log();
  for (std::size_t at = 0; (at = all.find(text, at)) != std::string::npos; ++at) ++count;
  return count;
}

bool ServiceHarness::eventually(const std::function<bool()>& holds, milliseconds patience) {
  const auto deadline = steady_clock::now() + patience * (kSanitized ? 10 : 1);
  while (!holds()) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(milliseconds(10));
  }
  return true;
}

bool ServiceHarness::eventually_done(std::uint64_t jobs, milliseconds patience) const {
  return eventually([&] { return count("done") == jobs; }, patience);
}

std::string ServiceHarness::difference(const std::string& source, const std::string& output,
                                       const std::vector<std::string>& options) const {
  const TemporaryDirectory scratch;
  std::vector<std::string> command{"convert", in(source), "-o", scratch / "plain.nvdb", "--threads", "1"};
  command.insert(command.end(), options.begin(), options.end());
  const CommandResult plain = run_weir(command);
  if (plain.exit_code != 0) return plain.err;
  if (!fs::exists(out(output))) return output + " is not there";
  if (read_file(out(output)) != read_file(scratch / "plain.nvdb")) return output + " has other bytes";
  return fs::exists(out(output + ".json")) ? "" : output + " has no sidecar";
}

std::vector<std::string> ServiceHarness::leftovers() const {
  std::vector<std::string> names;
  for (const std::string& name : list_directory(out())) {
    const auto ends = [&](const char* suffix) { return name.ends_with(suffix); };
    const bool hidden = fs::path(name).filename().string().starts_with('.');
    if (hidden || (!ends(".nvdb") && !ends(".nvdb.json") && !ends(".nvdb.png") && !ends("/"))) names.push_back(name);
  }
  return names;
}

}  // namespace weir
