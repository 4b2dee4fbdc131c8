// Compares the Fortran modules with the C headers that they repeat: every constant, member and argument. Also runs
// programs that use the modules, if there is a Fortran compiler.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "bindings/c/weir.h"
#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::fortran_test {
namespace {

const std::string kSource = WEIR_SOURCE_DIR "/";

std::string without(const std::string& text, const std::string& pattern) {
  return std::regex_replace(text, std::regex(pattern), " ");
}

std::string header(const std::string& name) {
  return without(read_file(kSource + "bindings/" + name), R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)");
}

/// Returns the text of a module with each statement on one line, without comments, abstract interfaces and procedures.
std::string module(const std::string& name) {
  std::string text = without(read_file(kSource + "examples/" + name), "![^\n]*");
  text = without(text, "&\\s*\n");
  text = text.substr(0, text.find("\ncontains"));
  const std::size_t begin = text.find("abstract interface");
  if (begin == std::string::npos) return text;
  return text.erase(begin, text.find("end interface", begin) - begin);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Returns the whole and the groups of each match. A group that took no part in the match is empty.
std::vector<std::vector<std::string>> all_of(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::vector<std::vector<std::string>> found;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), regex); match != std::sregex_iterator(); ++match) {
    found.emplace_back(match->begin(), match->end());
  }
  return found;
}

/// Splits `text` at the commas outside parentheses and removes all spaces.
std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> found{""};
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) {
      found.emplace_back();
    } else if (c != ' ' && c != '\n') {
      found.back() += c;
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

using Table = std::map<std::string, std::vector<std::string>>;

Table constants(const std::string& text, const char* pattern) {
  Table table;
  for (const auto& constant : all_of(text, pattern)) table[lower(constant[1])].push_back(constant[2]);
  return table;
}

/// Returns the Fortran type for a C type that is no pointer.
std::string kind_of(const std::string& type) {
  static const std::map<std::string, std::string> kinds{
      {"size_t", "integer(c_size_t)"},       {"int64_t", "integer(c_int64_t)"},
      {"uint64_t", "integer(c_int64_t)"},    {"int32_t", "integer(c_int32_t)"},
      {"weir_status", "integer(c_int32_t)"}, {"int", "integer(c_int)"},
      {"MPI_Fint", "integer(c_int)"},        {"float", "real(c_float)"},
      {"double", "real(c_double)"},          {"char", "character(kind=c_char)"}};
  const auto found = kinds.find(type);
  return found == kinds.end() ? cat("type(", type, ")") : found->second;
}

/// Returns "TYPE NAME" for each member, in order, by struct. Types and names are Fortran's.
Table structs(const std::string& c) {
  const std::map<std::string, std::string> renamed{{"size", "file_size"}, {"type", "scalar_type"}};
  const std::regex callback(R"(.*\(\*(\w+)\)\(.*)");
  const std::regex member(R"((?:const )?(\w+) ?(\*?) ?(\w+)(?:\[(\w+)\])?)");
  Table table;
  for (const auto& found : all_of(c, R"(typedef struct \w+ \{([^}]*)\} (\w+);)")) {
    for (const std::string& text : split(found[1], ';')) {
      const std::string declared = std::regex_replace(text, std::regex("^\\s+|\\s+$"), "");
      std::smatch match;
      if (declared.empty()) continue;
      if (std::regex_match(declared, match, callback)) {
        table[found[2]].push_back(cat("type(c_funptr) ", match.str(1)));
      } else if (std::regex_match(declared, match, member)) {
        const auto name = renamed.find(match[3]);
        const std::string type = match.length(2) != 0 ? "type(c_ptr)" : kind_of(match[1]);
        const std::string count = match.length(4) != 0 ? cat("(", lower(match[4]), ")") : "";
        table[found[2]].push_back(cat(type, " ", name == renamed.end() ? match.str(3) : name->second, count));
      } else {
        ADD_FAILURE() << "this test does not know the member " << declared;
      }
    }
  }
  return table;
}

Table types(const std::string& fortran) {
  Table table;
  for (const auto& found : all_of(fortran, R"(type, bind\(c\) :: (\w+)\n([\s\S]*?)end type)")) {
    for (const auto& line : all_of(found[2], R"( *([^\n]+?) :: ([^\n]+))")) {
      for (const std::string& name : parts(line[2])) table[found[1]].push_back(cat(line[1], " ", name));
    }
  }
  return table;
}

/// Returns the Fortran declarations of each C function, by its name: first the result, then the arguments. A pointer
/// may be an address by value or a reference to its target, written as "A or B".
Table calls(const std::string& c) {
  Table table;
  for (const auto& found : all_of(c, R"(WEIR_API ([^;(]*?)(weir_\w+)\(([^)]*)\);)")) {
    std::vector<std::string>& passed = table[found[2]];
    const std::string type = std::regex_replace(found[1], std::regex("const| "), "");
    passed.push_back(type.ends_with('*') ? "type(c_ptr)" : type == "void" ? type : kind_of(type));
    for (const auto& argument : all_of(found[3], R"((?:const )?(\w+)(\**) (\w+)(\[3\])?(?:,|$|\n))")) {
      const std::string kind = kind_of(argument[1]);
      const std::size_t depth = argument[2].size() + (argument[4].empty() ? 0 : 1);
      passed.push_back(depth == 0   ? kind + ", value"
                       : depth == 2 ? "type(c_ptr)"
                                    : cat("type(c_ptr), value or ", kind));
    }
    if (found[3] == "void") passed.resize(1);
  }
  return table;
}

Table interfaces(const std::string& fortran) {
  Table table;
  for (const auto& found :
       all_of(fortran, R"(\n *(?:(\S+) function|subroutine) (weir_\w+)\(([^)]*)\) bind\(c\)\n([\s\S]*?)\n +end )")) {
    std::map<std::string, std::string> declared;
    for (const auto& line : all_of(found[4], R"( *([^\n]+?) :: ([^\n]+))")) {
      for (const std::string& name : parts(line[2])) {
        const std::string type = without(line[1], ", intent\\(\\w+\\)");
        declared[name.substr(0, name.find('('))] = std::regex_replace(type, std::regex(" +$"), "");
      }
    }
    std::vector<std::string>& passed = table[found[2]];
    passed.push_back(found[1].empty() ? "void" : found[1]);
    for (const std::string& name : parts(found[3])) passed.push_back(declared[name]);
  }
  return table;
}

void expect_calls(const Table& c, const Table& fortran) {
  for (const auto& [name, passed] : c) {
    const auto found = fortran.find(name);
    ASSERT_NE(found, fortran.end()) << name << " has no interface";
    ASSERT_EQ(found->second.size(), passed.size()) << name;
    for (std::size_t i = 0; i < passed.size(); ++i) {
      const std::size_t choice = passed[i].find(" or ");
      const std::set<std::string> taken{passed[i].substr(0, choice),
                                        choice == std::string::npos ? passed[i] : passed[i].substr(choice + 4)};
      EXPECT_TRUE(taken.contains(found->second[i]))
          << name << ", " << i << ": " << found->second[i] << ", and C passes " << passed[i];
    }
  }
  for (const auto& [name, passed] : fortran) EXPECT_TRUE(c.contains(name)) << name << " is in no header";
}

TEST(Fortran, HasEveryConstantOfTheHeader) {
  const Table c = constants(header("c/weir.h"), R"((?:#define )?(WEIR_\w+)(?: =)? (-?\d+))");
  const Table fortran = constants(module("push/weir.f90"), R"((weir_\w+) = (-?\d+))");
  EXPECT_EQ(fortran, c);
  EXPECT_GE(c.size(), 60U);
}

TEST(Fortran, TypesHaveTheMembersOfTheStructs) {
  const Table c = structs(header("c/weir.h"));
  EXPECT_EQ(types(module("push/weir.f90")), c);
  EXPECT_EQ(c.size(), 5U);
}

TEST(Fortran, HasEveryCallOfTheHeaders) {
  const Table c = calls(header("c/weir.h"));
  EXPECT_GE(c.size(), 26U);
  expect_calls(c, interfaces(module("push/weir.f90")));
  Table mpi = calls(header("mpi/weir_mpi.h"));
  EXPECT_EQ(mpi.erase("weir_mpi_push_begin"), 1U);  // it takes a C communicator handle
  EXPECT_EQ(mpi.size(), 4U);
  expect_calls(mpi, interfaces(module("mpi/weir_mpi.f90")));
}

#ifdef WEIR_INSTALLS  // not in builds with sanitizers

TEST(Fortran, ValuesComeBackFromFilesAndMemory) {
  if (run_command({"sh", "-c", "command -v gfortran"}).exit_code != 0) GTEST_SKIP() << "no gfortran";
  const TemporaryDirectory work;
  CommandOptions here;
  here.directory = work.path();  // the compiler writes weir.mod there
  const std::string library = WEIR_C_LIBRARY;
  const CommandResult compiled =
      run_command({"gfortran", "-std=f2008", "-Wall", "-Wextra", "-Werror", "-fcheck=all", "-o", work / "round_trip",
                   kSource + "examples/push/weir.f90", kSource + "tests/bindings/fortran/round_trip.f90", library,
                   cat("-Wl,-rpath,", library.substr(0, library.rfind('/')))},
                  here);
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  const CommandResult run = run_command({work / "round_trip", "."}, here);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out,
            cat("version ", run_weir({"--version"}).out, "bytes ", sizeof(weir_error), ' ', sizeof(weir_volume), ' ',
                sizeof(weir_convert_options), ' ', sizeof(weir_input_options), ' ', sizeof(weir_grid_info),
                "\na.nvdb field 41 30 27 0 0 0 ", WEIR_ENCODING_PACKED, " 1\nb.nvdb field 41 30 27 0 0 0 ",
                WEIR_ENCODING_PACKED, " 1\nmemory density 41 30 27 1 1 1\nfile 33 30 20\n",
                "./none.nvdb: cannot open: No such file or directory\n"));
}

#endif

}  // namespace
}  // namespace weir::fortran_test
