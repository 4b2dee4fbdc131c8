// Tests the parts of the build that configure and package weir. CMake runs each part alone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::packaging_test {
namespace {

namespace fs = std::filesystem;

const std::string kCmake = WEIR_SOURCE_DIR "/cmake/";

/// Returns the result of weir_auto_option for `value`, or its message.
std::string read_option(const std::string& value) {
  const TemporaryDirectory work;
  write_file(work / "a.cmake", cat("include(\"", kCmake,
                                   "auto_option.cmake\")\n"
                                   "weir_auto_option(WEIR_PART \"Build the part\")\n"
                                   "message(NOTICE \"${WEIR_PART}\")\n"));
  const std::string err = run_command({WEIR_CMAKE, cat("-DWEIR_PART=", value), "-P", work / "a.cmake"}).err;
  const std::size_t message = err.find("WEIR_PART is ");
  if (message == std::string::npos) return err;
  return err.substr(message, err.find('\n', message) - message);
}

TEST(AutoOption, TakesEverySpellingOfABoolean) {
  for (const char* value : {"ON", "TRUE", "True", "yes", "Y", "1"}) EXPECT_EQ(read_option(value), "ON\n") << value;
  for (const char* value : {"OFF", "FALSE", "False", "no", "N", "0"}) EXPECT_EQ(read_option(value), "OFF\n") << value;
  for (const char* value : {"AUTO", "auto"}) EXPECT_EQ(read_option(value), "AUTO\n") << value;
}

TEST(AutoOption, RefusesAnythingElse) {
  for (const char* value : {"", "maybe", "2"}) {
    EXPECT_EQ(read_option(value), cat("WEIR_PART is '", value, "': give AUTO, ON or OFF"));
  }
}

/// Returns the files that cmake/install_unit.cmake installs for `prefix` with `root` as DESTDIR.
std::vector<std::string> unit_files(const TemporaryDirectory& root, const std::string& prefix) {
  CommandOptions options;
  options.environment = {cat("DESTDIR=", root.path().string())};
  const CommandResult installed = run_command(
      {WEIR_CMAKE, cat("-DCMAKE_INSTALL_PREFIX=", prefix), "-DWEIR_UNIT=" WEIR_SOURCE_DIR "/daemon/weir@.service",
       "-DWEIR_EXAMPLE=" WEIR_SOURCE_DIR "/daemon/example.toml", "-P", kCmake + "install_unit.cmake"},
      options);
  EXPECT_EQ(installed.exit_code, 0) << installed.err;
  std::vector<std::string> files;
  for (const std::string& name : list_directory(root.path())) {
    if (!name.ends_with('/')) files.push_back(name);
  }
  return files;
}

TEST(InstallUnit, WritesOutsideThePrefixOnlyForUsr) {
  const TemporaryDirectory system;
  EXPECT_EQ(unit_files(system, "/usr"),
            (std::vector<std::string>{"etc/weir/example.toml", "usr/lib/systemd/system/weir@.service"}));
  const TemporaryDirectory home;
  EXPECT_EQ(unit_files(home, "/home/a/usr"), (std::vector<std::string>{"home/a/usr/etc/weir/example.toml",
                                                                       "home/a/usr/lib/systemd/system/weir@.service"}));
}

/// Makes a Debian package with cmake/package.cmake and the umask 077. Returns its path. It has only its documents.
std::string make_package(const TemporaryDirectory& work, const std::string& daemon) {
  write_file(work / "CMakeLists.txt", cat("cmake_minimum_required(VERSION 3.25)\n"
                                          "project(weir VERSION " WEIR_VERSION " LANGUAGES NONE)\n"
                                          "set(PROJECT_SOURCE_DIR \"" WEIR_SOURCE_DIR "\")\n"
                                          "set(CMAKE_INSTALL_DOCDIR share/doc/weir)\n"
                                          "set(WEIR_DAEMON ",
                                          daemon, ")\ninclude(\"", kCmake, "package.cmake\")\n"));
  const CommandResult configured =
      run_command({WEIR_CMAKE, "-S", work.path(), "-B", work / "build", "-G", WEIR_GENERATOR});
  EXPECT_EQ(configured.exit_code, 0) << configured.err;
  const CommandResult packed =
      run_command({"sh", "-c", "umask 077; exec \"$0\" \"$@\"", WEIR_CPACK, "-D", "CPACK_DEBIAN_PACKAGE_SHLIBDEPS=OFF",
                   "--config", work / "build/CPackConfig.cmake", "-B", work / "packages"});
  EXPECT_EQ(packed.exit_code, 0) << packed.out << packed.err;
  for (const std::string& name : list_directory(work / "packages")) {
    if (name.ends_with(".deb")) return work / cat("packages/", name);
  }
  return {};
}

std::vector<std::string> control_files(const TemporaryDirectory& work, const std::string& package) {
  EXPECT_EQ(run_command({"dpkg-deb", "--control", package, work / "control"}).exit_code, 0);
  return list_directory(work / "control");
}

class DebianPackage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v dpkg-deb >/dev/null") != 0) GTEST_SKIP() << "dpkg-deb is not installed";
  }
};

TEST_F(DebianPackage, IsForAllWhateverTheUmask) {
  const TemporaryDirectory work;
  const std::string contents = run_command({"dpkg-deb", "--contents", make_package(work, "ON")}).out;
  std::size_t names = 0;
  for (const std::string& line : split(contents, '\n')) {
    if (line.empty()) continue;
    ++names;
    EXPECT_EQ(line.substr(0, 10), line.starts_with('d') ? "drwxr-xr-x" : "-rw-r--r--") << line;
  }
  EXPECT_GE(names, 6U) << contents;
}

TEST_F(DebianPackage, SpeaksOfTheServiceOnlyWhereThereIsOne) {
  const TemporaryDirectory with;
  EXPECT_EQ(control_files(with, make_package(with, "ON")),
            (std::vector<std::string>{"conffiles", "control", "md5sums", "postinst", "postrm", "prerm", "triggers"}));
  const TemporaryDirectory without;
  EXPECT_EQ(control_files(without, make_package(without, "OFF")),
            (std::vector<std::string>{"control", "md5sums", "triggers"}));
}

/// The checkout lies below folders with names that weir_library leaves out inside the checkout.
TEST(SourceFilters, LookOnlyBelowTheCheckout) {
  const TemporaryDirectory work;
  const std::string checkout = work / "a b/gpu/cuda/tools/without";
  for (const char* name : {"gpu/a.cpp", "gpu/main.cpp", "gpu/cuda/b.cpp", "gpu/left/c.cpp"}) {
    fs::create_directories(fs::path(cat(checkout, '/', name)).parent_path());
    write_file(cat(checkout, '/', name), "");
  }
  write_file(checkout + "/CMakeLists.txt", cat("cmake_minimum_required(VERSION 3.25)\n"
                                               "project(weir LANGUAGES CXX)\ninclude(\"",
                                               kCmake,
                                               "weir.cmake\")\n"
                                               "weir_library(gpu WITHOUT \"^tools/without/|/left/\")\n"
                                               "get_target_property(sources weir_gpu SOURCES)\n"
                                               "file(WRITE ${PROJECT_SOURCE_DIR}/sources \"${sources}\")\n"));
  const CommandResult configured = run_command(
      {WEIR_CMAKE, "-S", checkout, "-B", work / "build", "-G", WEIR_GENERATOR, "-DCMAKE_CXX_COMPILER=" WEIR_CXX});
  EXPECT_EQ(configured.exit_code, 0) << configured.err;
  EXPECT_EQ(read_file(checkout + "/sources"), checkout + "/gpu/a.cpp");
}

// CMake passes flags to a shell unchanged. So a path with a space needs quotes.
TEST(Presets, QuoteTheCheckoutInFlags) {
  std::size_t quoted = 0;
  const auto presets = nlohmann::json::parse(read_file(WEIR_SOURCE_DIR "/CMakePresets.json"));
  for (const auto& preset : presets.at("configurePresets")) {
    const auto variables = preset.value("cacheVariables", nlohmann::json::object());
    for (const auto& [name, value] : variables.items()) {
      if (!name.starts_with("CMAKE_") || name.find("_FLAGS") == std::string::npos) continue;
      const std::string flags = value.get<std::string>();
      for (std::size_t at = flags.find("${sourceDir}"); at != std::string::npos;
           at = flags.find("${sourceDir}", at + 1)) {
        EXPECT_EQ(flags.substr(at - 1, 1), "\"") << name << ": " << flags;
        ++quoted;
      }
    }
  }
  EXPECT_GE(quoted, 1U);
}

}  // namespace
}  // namespace weir::packaging_test
