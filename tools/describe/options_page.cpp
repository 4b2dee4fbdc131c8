#include "tools/describe/options_page.h"

#include <string_view>

#include "compressor/options/conversion_request.h"

namespace weir {
namespace {

/// Returns `text` escaped for a table cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

std::string line_of(const OptionRow& row) {
  const std::string value = row.flag() ? "" : cat(" `", cell(row.argument), "`");
  const std::string keyword = key_wording({std::string(row.key), {}});
  return cat("| `--", row.key, "`", value, " | `", keyword, "` | ", row.unit, " | ", cell(row.standard), " | ",
             cell(row.meaning()), " |\n");
}

std::string table(std::string_view title, std::string_view names, std::span<const ConversionOption> options) {
  std::string text =
      cat("\n## ", title, "\n\n| option | ", names, " | unit | default | meaning |\n|---|---|---|---|---|\n");
  for (const ConversionOption& option : options) text += line_of(option.row);
  return text;
}

}  // namespace

std::string options_page() {
  return cat(
      "# Options of a conversion\n\n"
      "One table in the program, `compressor/options`, says what options there are. The command line, the keys of a\n"
      "`[[watch]]` table and this page are made from it. The keywords of `weir.convert` in Python are checked against "
      "it.\nC has most of them as members of `weir_convert_options` and `weir_input_options`; `weir.h` describes "
      "those.\n"
      "`weir convert --help` explains further options of the command alone, such as `--skip-done`, `--dry-run`, "
      "`--within`,\n`--bandwidth` and `--json`.\n"
      "`weir man --options` prints this page. `weir man DIRECTORY`, which `weir --help` does not list, writes the "
      "manual\npages, for the installation.\n",
      table("Input: what a file does not say itself", "key, keyword", input_options()),
      table("Budget, method and policy", "key, keyword", method_options()),
      table("Use of the machine", "keyword of Python", run_options()),
      "\nOf `--size`, `--rate`, `--psnr`, `--max-error` and `--lossless` one can be given "
      "([budget.md](budget.md)). A `[[watch]]`\ntable takes the keys of the first two tables but `stack`, and "
      "`backend`; memory, threads and the like are the\nservice's ([operations.md](operations.md)).\n"
      "\nOf the name of `-o`, and of `name` in a `[[watch]]` table, three words are replaced. `{stem}` is the input's "
      "name without its\nsuffix. `{dataset}` is what `--dataset` names, with dots for slashes. `{step}` is the number "
      "by which a pattern with `%d`, of\nthe input or of `--dataset`, found the volume, or its position in a range of "
      "`--index`. A name with `{step}` is refused for a\nvolume that has no such number: files that `*` or a list "
      "names are told apart by `{stem}`. In a directory's name the words are\nrefused.\n"
      "\n`--overwrite` is of results: without it an existing one is refused, but `weir play` replaces its frames. What "
      "a command writes\nbesides is replaced: the chart or table of `weir compare --spectrum`, the chart of `weir "
      "inspect --plot`, and a trace; `--trace`\nrefuses any other file.\n"
      "\nIf the output is a symbolic link, `--overwrite` replaces the link itself. The file that it leads to stays as "
      "it "
      "was; to replace\nthat, give its own path.\n");
}

}  // namespace weir
