#include "format/base/trace.h"

#include <cerrno>

#include "format/base/error.h"

namespace weir {
namespace {

double microseconds(Trace::Clock::duration time) { return std::chrono::duration<double, std::micro>(time).count(); }

}  // namespace

// The JSON array form of "Trace Event Format" (Google): complete events, "X", in microseconds, and a name for each
// thread. That form allows the closing bracket to be missing.
Trace::Trace(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "we")) {
  if (file_ == nullptr) throw io_error(path, "create", errno);
  threads_[std::this_thread::get_id()] = 0;
  std::fputs("[\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":0,\"args\":{\"name\":\"main\"}}",
             file_.get());
}

Trace::~Trace() {
  try {
    if (file_ != nullptr) close();
  } catch (const Error&) {
    // The earlier failure is the one to report.
  }
}

void Trace::add(const char* name, Clock::time_point begin, Clock::time_point end, std::uint64_t bytes) {
  const std::scoped_lock lock(mutex_);
  std::FILE* file = file_.get();
  const auto [at, is_new] = threads_.try_emplace(std::this_thread::get_id(), static_cast<int>(threads_.size()));
  const int thread = at->second;
  if (is_new) {
    std::fprintf(file,
                 ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"args\":{\"name\":\"thread %d\"}}",
                 thread, thread);
  }
  std::fprintf(file, ",\n{\"name\":\"%s\",\"ph\":\"X\",\"pid\":1,\"tid\":%d,\"ts\":%.3f,\"dur\":%.3f", name, thread,
               microseconds(begin - start_), microseconds(end - begin));
  if (bytes > 0) std::fprintf(file, ",\"args\":{\"bytes\":%llu}", static_cast<unsigned long long>(bytes));
  std::fputc('}', file);
}

void Trace::close() {
  const std::scoped_lock lock(mutex_);
  std::fputs("\n]\n", file_.get());
  const bool failed = std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0;
  const int reason = errno;
  file_.reset();
  if (failed) throw io_error(path_, "write the trace", reason);
}

}  // namespace weir
