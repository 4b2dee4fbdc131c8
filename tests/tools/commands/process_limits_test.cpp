// Tests limits of a process: file size, open files, memory for all processors, a terminal. Each failure prints one
// line, has the exit code of its kind and leaves nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "ingest/plan/staging.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::process_limits_test {
namespace {

namespace fs = std::filesystem;

class ProcessLimits : public ::testing::Test {
 protected:
  ProcessLimits() { fs::create_directory(directory_ / "out"); }

  std::string volume(std::size_t edge) const {
    const std::string e = std::to_string(edge);
    const std::string path = directory_ / ("v_" + e + "x" + e + "x" + e + "_uint8.raw");
    std::string bytes(edge * edge * edge, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 2654435761U >> 24U);
    write_file(path, bytes);
    return path;
  }
  CommandResult run_limited(const std::string& limit, const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"bash", "-c", limit + " && exec \"$0\" \"$@\"", WEIR_COMMAND};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_command(command);
  }
  std::vector<std::string> left() const { return list_directory(directory_ / "out"); }

  /// Makes a library that replaces system functions in a command which is run with it.
  std::vector<std::string> preload(const std::string& source) const {
    const std::string library = directory_ / "instead.so";
    write_file(directory_ / "instead.c", source);
    const CommandResult built = run_command({"cc", "-shared", "-fPIC", "-o", library, directory_ / "instead.c"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return {"LD_PRELOAD=" + library};
  }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "out/v.nvdb";
};

TEST_F(ProcessLimits, FileSizeLimit_IsAnIoErrorAndLeavesNothing) {
  const CommandResult result = run_limited("ulimit -f 16", {"convert", volume(64), "-o", output_, "--lossless"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(
      result.err.find(": File too large; raise the limit of file size (ulimit -f) or choose another file system\n"),
      std::string::npos)
      << result.err;
  EXPECT_TRUE(result.err.starts_with("weir: " + (directory_ / "out/"))) << result.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, OpenFilesLimit_OfAStack_IsAnIoError) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer needs descriptors, too";
  for (const char* name : {"p_0_16x16x8_uint8.raw", "p_1_16x16x8_uint8.raw"}) {
    write_file(directory_ / name, std::string(16 * 16 * 8, '\1'));
  }
  const CommandResult result = run_limited(
      "exec 3>&- 4>&- 5>&-; ulimit -n 4", {"convert", directory_ / "p_%d_16x16x8_uint8.raw", "--stack", "-o", output_});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_NE(result.err.find(": Too many open files; raise the limit of open files (ulimit -n)\n"), std::string::npos)
      << result.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, NewlineInAPath_KeepsTheErrorOnOneLine) {
  const std::string path = directory_ / "a\nb\x1b[2J_8x8x8_uint8.raw";
  const CommandResult result = run_weir({"convert", path, "-o", output_});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "weir: " + (directory_ / "a\\nb\\x1b[2J_8x8x8_uint8.raw: no file has such a name; give files, or "
                                     "a pattern in quotes\n"));
}

TEST_F(ProcessLimits, TheLongestName_HasAWorkDirectoryOfItsOwn) {
  const std::string output = directory_ / ("out/" + std::string(236, 'n') + ".nvdb");
  fs::create_directory(directory_ / "work");
  const CommandResult result = run_weir(
      {"convert", volume(64), "-o", output, "--work-dir", directory_ / "work", "--resume", "on", "--lossless"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(output));
  EXPECT_EQ(list_directory(directory_ / "work"), std::vector<std::string>{});
}

TEST_F(ProcessLimits, NamesTooLong_AreRefusedInOneLine) {
  const std::string name(250, 'n');
  const CommandResult output = run_weir({"convert", volume(16), "-o", directory_ / ("out/" + name), "--skip-done"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_EQ(output.err, "weir: " + (directory_ / ("out/" + name)) +
                            ": its name has 250 bytes, and with what weir writes beside it at most 241 can be used; "
                            "choose a shorter one\n");
  for (const char* command : {"convert", "inspect", "verify", "play"}) {
    const CommandResult input = run_weir({command, directory_ / (name + "_%d_" + name), "-o", output_});
    EXPECT_NE(input.exit_code, 1) << command << input.err;
    EXPECT_EQ(input.err.find("internal fault"), std::string::npos) << command << input.err;
  }
}

TEST_F(ProcessLimits, NewlineInAPath_KeepsANoticeOnOneLine) {
  const std::string path = directory_ / "a\nb_16x16x16_uint8.raw";
  fs::rename(volume(16), path);
  const CommandResult result = run_weir({"convert", path, "-o", directory_ / "out/a\nb.nvdb", "--log-level", "warn"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(" warning " + (directory_ / "out/a\\nb.nvdb: no budget was given, ")), std::string::npos)
      << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST_F(ProcessLimits, Hangup_EndsWith129AndNothingIsLeft) {
  const std::string path = directory_ / "zeros_1024x1024x1024_uint8.raw";
  write_file(path, "");
  fs::resize_file(path, std::uintmax_t{1} << 30U);
  ChildProcess child({WEIR_COMMAND, "convert", path, "-o", output_, "--threads", "1", "--resume", "off"});
  while (child.running() && left().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.send_signal(SIGHUP);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 129);
  EXPECT_EQ(result.err, "weir: interrupted; nothing was written\n");
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, Threads_AreFewerOrAClearError) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string path = volume(96);
  const auto run_with = [&](int threads, std::vector<std::string> arguments) {
    CommandOptions options;
    options.environment = preload(
        "#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <errno.h>\n#include <pthread.h>\n#include <stdlib.h>\n"
        "static int running;\n"
        "struct call { void* (*run)(void*); void* with; };\n"
        "static void* counted(void* p) {\n"
        "  struct call c = *(struct call*)p; free(p);\n"
        "  void* result = c.run(c.with);\n"
        "  __sync_fetch_and_sub(&running, 1); return result;\n}\n"
        "int pthread_create(pthread_t* t, const pthread_attr_t* a, void* (*run)(void*), void* with) {\n"
        "  if (__sync_fetch_and_add(&running, 1) >= " +
        std::to_string(threads) +
        ") { __sync_fetch_and_sub(&running, 1); return EAGAIN; }\n"
        "  struct call* c = malloc(sizeof *c); c->run = run; c->with = with;\n"
        "  int (*real)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) = dlsym(RTLD_NEXT, "
        "\"pthread_create\");\n"
        "  return real(t, a, counted, c);\n}\n");
    return run_weir(std::move(arguments), options);
  };
  const auto convert_with = [&](int threads) {
    return run_with(threads, {"convert", path, "-o", output_, "--overwrite", "--threads", "8"});
  };
  const CommandResult all = convert_with(1000);
  ASSERT_EQ(all.exit_code, 0) << all.err;
  const std::string bytes = read_file(output_);
  for (const int threads : {13, 2}) {
    const CommandResult fewer = convert_with(threads);
    EXPECT_EQ(fewer.exit_code, 0) << fewer.err;
    EXPECT_NE(
        fewer.err.find("the system lets this process start " + std::to_string(threads) + " threads more; working on " +
                       (threads == 13 ? "4" : "1") + "; raise the limit of processes (ulimit -u)\n"),
        std::string::npos)
        << fewer.err;
    EXPECT_TRUE(read_file(output_) == bytes) << threads;
  }
  // Reads ahead, in several blocks.
  const auto read_ahead = [&](int threads) {
    return run_with(threads,
                    {"convert", volume(200), "-o", output_, "--overwrite", "--threads", "8", "--direct-io", "on"});
  };
  ASSERT_EQ(read_ahead(1000).exit_code, 0);
  const std::string ahead = read_file(output_);
  for (const int threads : {17, 16, 13, 2}) {
    const CommandResult fewer = read_ahead(threads);
    EXPECT_EQ(fewer.exit_code, 0) << threads << fewer.err;
    EXPECT_TRUE(read_file(output_) == ahead) << threads;
  }
  ASSERT_EQ(convert_with(1000).exit_code, 0);
  const std::string none_left =
      "weir: no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit -v), "
      "or end some\n";
  for (const std::string command : {"verify", "inspect"}) {
    const CommandResult fewer = run_with(2, {command, output_});
    EXPECT_EQ(fewer.exit_code, 0) << command << fewer.err;
    EXPECT_NE(fewer.err.find("the system lets this process start 2 threads more; working on 1"), std::string::npos)
        << command << fewer.err;
    const CommandResult none = run_with(0, {command, output_});
    EXPECT_EQ(none.exit_code, 5) << command;
    EXPECT_TRUE(none.err.ends_with(none_left)) << command << none.err;
  }
  fs::remove(output_);
  fs::remove(output_ + ".json");
  const CommandResult none = convert_with(0);
  EXPECT_EQ(none.exit_code, 5);
  EXPECT_TRUE(none.err.ends_with(none_left)) << none.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, ThreadsThatRunOutDuringAConversion_CostNothing) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  // Counted after the threads that a conversion of one thread starts to find its limit; oneTBB keeps its own threads.
  const std::string counted = std::to_string(2 * kIoThreads + 2);
  CommandOptions denied;
  denied.environment = preload(
      "#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <errno.h>\n#include <pthread.h>\n#include <string.h>\n"
      "static int started;\n"
      "int pthread_create(pthread_t* t, const pthread_attr_t* a, void* (*run)(void*), void* with) {\n"
      "  Dl_info caller;\n"
      "  dladdr(__builtin_return_address(0), &caller);\n"
      "  if (strstr(caller.dli_fname, \"libtbb\") == 0 && __sync_fetch_and_add(&started, 1) >= " +
      counted +
      ") return EAGAIN;\n"
      "  int (*real)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) = dlsym(RTLD_NEXT, "
      "\"pthread_create\");\n"
      "  return real(t, a, run, with);\n}\n");
  const std::string path = volume(164);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--size", "16777216"}, {"--resume", "on", "--save-interval", "0.001"}}) {
    std::vector<std::string> command{"convert", path, "-o", output_, "--overwrite", "--threads", "1", "-q"};
    command.insert(command.end(), options.begin(), options.end());
    ASSERT_EQ(run_weir(command).exit_code, 0);
    const std::string expected = read_file(output_);
    const CommandResult result = run_weir(command, denied);
    EXPECT_EQ(result.exit_code, 0) << options.front() << ": " << result.err;
    EXPECT_TRUE(read_file(output_) == expected) << options.front();
  }
}

TEST_F(ProcessLimits, FileOfKnownSize_IsReservedBesideTheSurvey) {
  CommandOptions told;
  told.environment = preload(
      "#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <fcntl.h>\n#include <sys/syscall.h>\n#include <unistd.h>\n"
      "int fallocate(int file, int mode, off_t offset, off_t bytes) {\n"
      "  if (syscall(SYS_gettid) != getpid()) (void)!write(2, \"beside\\n\", 7);\n"
      "  int (*real)(int, int, off_t, off_t) = dlsym(RTLD_NEXT, \"fallocate\");\n"
      "  return real(file, mode, offset, bytes);\n}\n");
  const CommandResult result =
      run_weir({"convert", volume(164), "-o", output_, "--size", "16777216", "--threads", "1", "-q"}, told);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "beside\n");
}

TEST_F(ProcessLimits, ManyProcessors_DefaultCeilingLimitsTheThreads) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string path = volume(64);
  std::string bytes;
  for (const int processors : {1, 8, 128, 512}) {
    CommandOptions options;
    options.environment = preload("int get_nprocs(void) { return " + std::to_string(processors) + "; }\n");
    const CommandResult result = run_weir({"convert", path, "-o", output_, "--overwrite"}, options);
    ASSERT_EQ(result.exit_code, 0) << processors << ": " << result.err;
    const bool fewer = result.err.find(" of " + std::to_string(processors) + " threads; give more to use them all") !=
                       std::string::npos;
    EXPECT_EQ(fewer, processors >= 128) << result.err;
    EXPECT_TRUE(bytes.empty() || bytes == read_file(output_)) << processors;
    bytes = read_file(output_);
  }
  CommandOptions options;
  options.environment = preload("int get_nprocs(void) { return 512; }\n");
  const CommandResult asked = run_weir({"convert", path, "-o", output_, "--overwrite", "--threads", "512"}, options);
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_NE(asked.err.find(" is too small for this volume with 512 threads; give at least "), std::string::npos);
}

}  // namespace
}  // namespace weir::process_limits_test
