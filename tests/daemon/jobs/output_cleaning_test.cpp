#include "daemon/jobs/output_cleaning.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <future>
#include <thread>

#include "compressor/resume/journal.h"
#include "daemon/store/file_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/io/file_system.h"
#include "tests/support/child_answer.h"
#include "tests/support/killed_overwrite.h"
#include "tests/support/run_command.h"

namespace weir::output_cleaning_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using std::chrono::milliseconds;

// Cleans with no source in the service's directory.
CleaningReport clean(const TemporaryDirectory& directory, bool recursive = false,
                     milliseconds patience = milliseconds(0)) {
  return clean_outputs(directory.path().string(), "/no/such/sources", recursive, patience);
}

// Cleans with `sources` as the service's directory.
CleaningReport clean(const TemporaryDirectory& directory, const TemporaryDirectory& sources) {
  return clean_outputs(directory.path().string(), sources.path().string(), false, milliseconds(0));
}

TEST(OutputCleaning, RemovesOnlyTheLeftoversOfKilledConversions) {
  const TemporaryDirectory directory;
  fs::create_directories(directory / ".a.nvdb.work");
  fs::create_directories(directory / "deep/.b.nvdb.work");
  fs::create_directories(directory / "precious.nvdb.partial");  // a directory is no partial file
  for (const char* name : {"a.nvdb.partial", "a.nvdb.json.partial", "a.nvdb.png.partial", ".a.nvdb.work/spillAb3dE6",
                           "deep/b.nvdb.partial", "done.nvdb", "done.nvdb.json", "done.nvdb.png", "notes.partial",
                           "old.nvdb.json", "old.nvdb.json.previous", "lost.nvdb.json.previous"}) {
    write_file(directory / name, name);
  }
  const CleaningReport report = clean(directory);
  EXPECT_EQ(report.left, Names{});
  EXPECT_EQ(report.removed,
            (Names{directory / ".a.nvdb.work", directory / "a.nvdb.json.partial", directory / "a.nvdb.png.partial",
                   directory / "a.nvdb.partial", directory / "old.nvdb.json.previous"}));
  EXPECT_EQ(list_directory(directory.path()),
            (Names{"deep/", "deep/.b.nvdb.work/", "deep/b.nvdb.partial", "done.nvdb", "done.nvdb.json", "done.nvdb.png",
                   "lost.nvdb.json", "notes.partial", "old.nvdb.json", "precious.nvdb.partial/"}));
  EXPECT_EQ(read_file(directory / "lost.nvdb.json"), "lost.nvdb.json.previous") << "the record came back";
  clean(directory, true);
  EXPECT_EQ(list_directory(directory / "deep"), Names{});
}

// From here on no thread of this process can read a directory, as on a failing disk. Returns whether this works.
bool fail_directories() {
  std::array<sock_filter, 4> steps{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                                    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_getdents64, 0, 1),
                                    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EIO),
                                    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog filter{static_cast<unsigned short>(steps.size()), steps.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &filter) == 0;
}

// There are more spill files than one system call lists, so the second call fails after the first removal.
TEST(OutputCleaning, WorkDirectoryThatCannotBeReadToItsEnd_StaysAndIsReported) {
  constexpr int kFiles = 6000;
  const TemporaryDirectory directory;
  const std::string work = directory / ".a.nvdb.work";
  fs::create_directories(work);
  for (int i = 0; i < kFiles; ++i) write_file(cat(work, "/spill", 100'000 + i), "");
  const std::string answer = answer_of_child([&] {
    const Descriptor removals(::inotify_init1(IN_CLOEXEC));
    ::inotify_add_watch(removals.get(), work.c_str(), IN_DELETE);
    std::future<bool> failing = std::async(std::launch::async, [&] {
      std::array<char, 4096> event{};
      return ::read(removals.get(), event.data(), event.size()) > 0 && fail_directories();
    });
    const Names left = clean(directory).left;
    if (!failing.get()) return std::string("no seccomp");
    return left.size() == 1 ? left[0].substr(directory.path().string().size()) : cat(left.size(), " reports");
  });
  if (answer == "no seccomp") GTEST_SKIP() << answer;
  EXPECT_EQ(answer, "/.a.nvdb.work: Directory not empty");
}

TEST(OutputCleaning, KillBetweenTheRenames_TheOldVolumeGetsItsSidecarBack) {
  const TemporaryDirectory directory;
  for (const char* name : {"old", "new"}) {
    const std::string source = directory / cat(name, "_16x16x16_uint8.raw");
    write_file(source, std::string(16 * 16 * 16, name[0]));
    const CommandResult made =
        run_weir({"convert", source, "-o", directory / cat(name, ".nvdb"), "--progress", "never"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  fs::rename(directory / "old.nvdb", directory / "out.nvdb");
  fs::rename(directory / "old.nvdb.json", directory / "out.nvdb.json.previous");
  fs::rename(directory / "new.nvdb.json", directory / "out.nvdb.json");
  const std::string old = read_file(directory / "out.nvdb.json.previous");
  clean(directory);
  EXPECT_EQ(read_file(directory / "out.nvdb.json"), old);
  EXPECT_FALSE(fs::exists(directory / "out.nvdb.json.previous"));
  // Beside a volume that neither sidecar describes, both stay, and this is reported.
  write_file(directory / "out.nvdb.json.previous", old);
  fs::rename(directory / "new.nvdb", directory / "out.nvdb");
  const CleaningReport report = clean(directory);
  EXPECT_EQ(report.left, Names{cat(directory / "out.nvdb.json.previous", ": may be the sidecar of ",
                                   directory / "out.nvdb", ", which cannot be told; compare it by weir verify")});
  EXPECT_EQ(read_file(directory / "out.nvdb.json"), old);
  EXPECT_EQ(read_file(directory / "out.nvdb.json.previous"), old);
}

// This holds even if size and head checksum of both volumes are equal.
TEST(OutputCleaning, KillBetweenTheRenames_OfVolumesWithEqualHeads_ThePairsAreRestored) {
  const TemporaryDirectory directory;
  const KilledOverwrite killed(directory);
  EXPECT_EQ(clean(directory).left, Names{});
  EXPECT_EQ(read_file(killed.output), killed.old_volume);
  EXPECT_EQ(read_file(killed.sidecar), killed.old_sidecar);
  const Names pair{"noise_64x64x64_uint8.raw", "out.nvdb", "out.nvdb.json"};
  EXPECT_EQ(list_directory(directory.path()), pair);
  // The same overwrite, killed a moment later: only the removal of the old sidecar is missing.
  write_file(killed.output, killed.new_volume);
  write_file(killed.sidecar, killed.new_sidecar);
  write_file(killed.previous, killed.old_sidecar);
  EXPECT_EQ(clean(directory).removed, Names{killed.previous});
  EXPECT_EQ(read_file(killed.sidecar), killed.new_sidecar);
  // The old volume had no sidecar.
  write_file(killed.output, killed.old_volume);
  write_file(killed.partial, killed.new_volume);
  EXPECT_EQ(clean(directory).removed, (Names{killed.sidecar, killed.partial}));
  EXPECT_EQ(read_file(killed.output), killed.old_volume);
}

// A reader that holds the sidecar open and locked must not make it look like another volume's.
TEST(OutputCleaning, SidecarThatAnotherProcessHasOpen_IsNotReplaced) {
  const TemporaryDirectory directory;
  const std::string source = directory / "a_16x16x16_uint8.raw";
  write_file(source, std::string(16 * 16 * 16, 'a'));
  const std::string output = directory / "a.nvdb";
  const CommandResult made = run_weir({"convert", source, "-o", output, "--progress", "never"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string sidecar = output + ".json";
  fs::copy_file(sidecar, sidecar + ".previous");
  const auto live = identify(sidecar);
  const auto other = make_posix_file_system()->open(sidecar);
  const CleaningReport report = clean(directory);
  EXPECT_EQ(report.left, Names{});
  EXPECT_EQ(report.removed, Names{sidecar + ".previous"});
  EXPECT_EQ(identify(sidecar), live);
}

// The volume that the sidecar describes is unknown now, but may be known at the next start.
TEST(OutputCleaning, SidecarThatCannotBeLookedAt_StaysWithThePreviousOne) {
  const TemporaryDirectory directory;
  const std::string sidecar = directory / "a.nvdb.json";
  write_file(directory / "a.nvdb", "volume");
  write_file(sidecar + ".previous", "previous");
  fs::create_symlink(std::string(300, 'x'), sidecar);  // a link to a name that no file can have
  const CleaningReport report = clean(directory);
  EXPECT_EQ(report.left, Names{cat(sidecar, ".previous: ", sidecar,
                                   ": cannot look at it: File name too long; choose a shorter name")});
  EXPECT_TRUE(fs::is_symlink(sidecar));
  EXPECT_EQ(read_file(sidecar + ".previous"), "previous");
  EXPECT_FALSE(fs::exists(directory / "a.nvdb.partial")) << "the lock";
}

// Writes the leftovers of an interrupted conversion of `source` to "a.nvdb", with spill files in `spills` or beside
// it.
void leave_interrupted(const TemporaryDirectory& directory, const std::string& source, const std::string& spills = "",
                       const ConversionIdentity& more = {}) {
  const FileIdentity identity = identify(source).value_or(FileIdentity{});
  ConversionIdentity all{
      {"source", source}, {"source bytes", cat(identity.bytes)}, {"source modified (ns)", cat(identity.mtime_ns)}};
  for (const auto& [name, value] : more) all[name] = value;
  const auto files = make_posix_file_system();
  Journal journal(*files, directory / "a.nvdb", all, {spills, 0, nullptr, nullptr, {}});
  journal.open("rows")->preallocate(100);
  journal.state.survey.done.add({{0, 0, 0}, {1, 1, 1}});
  journal.save_now();
}

const Names kKept{".a.nvdb.work/", ".a.nvdb.work/journal", ".a.nvdb.work/rows"};

void make_old(const TemporaryDirectory& directory) {
  fs::last_write_time(directory / ".a.nvdb.work", fs::file_time_type::clock::now() - std::chrono::hours(8 * 24));
}

TEST(OutputCleaning, KeepsResumableWorkForAWeekWhileItsSourceIsUnchanged) {
  const TemporaryDirectory directory;
  const TemporaryDirectory sources;
  const std::string source = sources / "a.raw";
  write_file(source, "source");

  leave_interrupted(directory, source);
  write_file(directory / "a.nvdb.partial", "");
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / "a.nvdb.partial"})
      << "the lock of a process that is dead";
  EXPECT_EQ(list_directory(directory.path()), kKept);

  write_file(source, "another source");
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"});
  EXPECT_EQ(list_directory(directory.path()), Names{});

  leave_interrupted(directory, source);
  fs::remove(source);
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"});

  write_file(source, "source");
  leave_interrupted(directory, source);
  make_old(directory);
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"}) << "for a week";

  leave_interrupted(directory, source);
  fs::resize_file(directory / ".a.nvdb.work/rows", 99);
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"}) << "worth nothing";
  EXPECT_EQ(list_directory(directory.path()), Names{});
}

// The recorded size and time are of all the source's files together. The next conversion finds out which file
// changed.
TEST(OutputCleaning, KeepsResumableWorkWhileItsHeaderExists) {
  const TemporaryDirectory directory;
  const TemporaryDirectory sources;
  const std::string source = sources / "a.nhdr";
  write_file(source, "header");
  leave_interrupted(directory, source, "", {{"source bytes", "7"}, {"source files", "0123"}});
  EXPECT_EQ(clean(directory, sources).removed, Names{});
  EXPECT_EQ(list_directory(directory.path()), kKept);
  fs::remove(source);
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"});
}

TEST(OutputCleaning, KeepsResumableWorkOfStacksAndOfSourcesElsewhere) {
  const TemporaryDirectory directory;
  const TemporaryDirectory sources;
  const TemporaryDirectory elsewhere;
  const auto expect_kept = [&] {
    make_old(directory);
    EXPECT_EQ(clean(directory, sources).removed, Names{});
    EXPECT_EQ(list_directory(directory.path()), kKept);
  };
  leave_interrupted(directory, elsewhere / "gone.raw");
  expect_kept();
  leave_interrupted(directory, sources.path().string() + "_not/gone.raw");
  expect_kept();
  leave_interrupted(directory, sources / "slice_%04d.raw", "", {{"format", "stack"}});
  expect_kept();
  leave_interrupted(directory, sources / "gone.raw");
  EXPECT_EQ(clean(directory, sources).removed, Names{directory / ".a.nvdb.work"});
}

TEST(OutputCleaning, SourcesThatCannotBeLookedAt_OwnNothing) {
  const TemporaryDirectory directory;
  const TemporaryDirectory elsewhere;
  leave_interrupted(directory, elsewhere / "gone.raw");
  make_old(directory);
  const std::string unusable = elsewhere / std::string(300, 'x');
  EXPECT_EQ(clean_outputs(directory.path().string(), unusable, false, milliseconds(0)).removed, Names{});
  EXPECT_EQ(list_directory(directory.path()), kKept);
}

// A conversion that begins during the cleaning keeps its files.
TEST(OutputCleaning, RemovesWorkOnlyWhileHoldingItsLock) {
  const TemporaryDirectory directory;
  const std::string work = directory / ".a.nvdb.work";
  std::atomic<bool> over{false};
  const auto cleaning = std::async(std::launch::async, [&] {
    while (!over) clean(directory);
  });
  const auto files = make_posix_file_system();
  int conversions = 0;
  int robbed = 0;
  const auto end = std::chrono::steady_clock::now() + milliseconds(500);
  while (std::chrono::steady_clock::now() < end) {
    std::unique_ptr<File> lock;
    try {
      lock = files->create(directory / "a.nvdb.partial");
    } catch (const Error&) {
      continue;  // the cleaner holds the lock
    }
    ++conversions;
    files->make_directory(work);
    write_file(work + "/rows", "rows");
    std::this_thread::yield();
    robbed += files->exists(work + "/rows") && files->exists(directory / "a.nvdb.partial") ? 0 : 1;
  }
  over = true;
  cleaning.wait();
  EXPECT_GT(conversions, 10);
  EXPECT_EQ(robbed, 0) << "of " << conversions;
}

TEST(OutputCleaning, DiscardsTheInterruptedWorkOfOneSource) {
  const TemporaryDirectory directory;
  const TemporaryDirectory sources;
  write_file(sources / "a.raw", "source");
  write_file(sources / "b.raw", "source");
  fs::create_directory(directory / ".c.nvdb.work");
  leave_interrupted(directory, sources / "a.raw");
  const auto discard = [&](const std::string& name) {
    return discard_interrupted(directory.path().string(), sources / name);
  };
  EXPECT_EQ(discard("b.raw").removed, Names{});
  {
    const auto writer = make_posix_file_system()->create(directory / "a.nvdb.partial");
    const CleaningReport report = discard("a.raw");
    EXPECT_EQ(report.removed, Names{});
    EXPECT_EQ(report.left, Names{(directory / "a.nvdb.partial") + ": another process is writing it"});
  }
  fs::remove(directory / "a.nvdb.partial");
  EXPECT_EQ(discard("a.raw").removed, Names{directory / ".a.nvdb.work"});
  EXPECT_EQ(list_directory(directory.path()), Names{".c.nvdb.work/"});
  EXPECT_EQ(discard_interrupted("/nowhere/at/all", "a.raw").removed, Names{});
}

TEST(OutputCleaning, RemovesSpillFilesInOtherDirectories) {
  const TemporaryDirectory directory;
  const TemporaryDirectory elsewhere;
  write_file(elsewhere / "a.raw", "source");
  fs::create_directory(elsewhere / "spills");
  leave_interrupted(directory, elsewhere / "a.raw", elsewhere / "spills");
  EXPECT_EQ(list_directory(elsewhere / "spills").size(), 2U) << "a directory of its own and the rows";
  fs::remove(elsewhere / "a.raw");
  EXPECT_EQ(clean(directory, elsewhere).removed, Names{directory / ".a.nvdb.work"});
  EXPECT_EQ(list_directory(elsewhere / "spills"), Names{});
}

TEST(OutputCleaning, AMissingDirectoryHasNothingToRemove) {
  EXPECT_EQ(clean_outputs("/nowhere/at/all", "/nowhere", true, milliseconds(0)).removed, Names{});
}

TEST(OutputCleaning, LeavesFilesThatAnotherProcessIsWriting) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / ".a.nvdb.work");
  const auto writer = make_posix_file_system()->create(directory / "a.nvdb.partial");
  const CleaningReport report = clean(directory, false, milliseconds(20));
  EXPECT_EQ(report.removed, Names{});
  EXPECT_EQ(report.left, Names{(directory / "a.nvdb.partial") + ": another process is writing it"});
  EXPECT_EQ(list_directory(directory.path()), (Names{".a.nvdb.work/", "a.nvdb.partial"}));
}

// The process that renders a picture does not hold the volume's lock.
TEST(OutputCleaning, PictureThatIsBeingRendered_IsKeptUntilItsWriterEnds) {
  const TemporaryDirectory directory;
  const std::string picture = directory / "a.nvdb.png.partial";
  auto writer = make_posix_file_system()->create(picture);
  const CleaningReport report = clean(directory);
  EXPECT_EQ(report.removed, Names{});
  EXPECT_EQ(report.left, Names{}) << "it is no leftover";
  EXPECT_EQ(list_directory(directory.path()), Names{"a.nvdb.png.partial"});
  writer.reset();
  EXPECT_EQ(clean(directory).removed, Names{picture});
}

TEST(OutputCleaning, WaitsForAWriterThatIsAboutToEnd) {
  const TemporaryDirectory directory;
  auto writer = make_posix_file_system()->create(directory / "a.nvdb.partial");
  const auto death = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(milliseconds(50));
    writer.reset();
  });
  EXPECT_EQ(clean(directory, false, milliseconds(5000)).removed, Names{directory / "a.nvdb.partial"});
}

}  // namespace
}  // namespace weir::output_cleaning_test
