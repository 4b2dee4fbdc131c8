#include "bindings/mpi/mpi_team.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr int kTag = 1;
constexpr std::size_t kMostBytes = std::size_t{1} << 30U;  // per message, because counts are int

// Returns the last byte of a part: whether the rank is unwinding.
std::byte unwinding() { return static_cast<std::byte>(std::uncaught_exceptions() > 0 ? 1 : 0); }

// Calls call(first byte, count) for each piece of a part that fits a message.
template <typename Part, typename Call>
void for_each_message(Part& part, const std::string& action, const Call& call) {
  for (std::size_t at = 0; at < part.size(); at += kMostBytes) {
    check_mpi(call(part.data() + at, static_cast<int>(std::min(kMostBytes, part.size() - at))), action);
  }
}

}  // namespace

void check_mpi(int code, const std::string& action) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw Error(ErrorKind::io, cat("MPI: ", action, ": ", std::string(text.data(), static_cast<std::size_t>(length))));
}

MpiTeam::MpiTeam(MPI_Comm communicator) {
  int threads = MPI_THREAD_SINGLE;
  check_mpi(MPI_Query_thread(&threads), "asking for threads");
  if (threads < MPI_THREAD_SERIALIZED) {
    throw Error(ErrorKind::usage,
                "MPI was initialised without MPI_THREAD_SERIALIZED; use MPI_Init_thread with that, or more");
  }
  check_mpi(MPI_Comm_dup(communicator, &communicator_), "copying the communicator");
  check_mpi(MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN), "setting the error handler");
  check_mpi(MPI_Comm_rank(communicator_, &rank_), "asking for the rank");
  check_mpi(MPI_Comm_size(communicator_, &size_), "asking for the number of processes");
}

MpiTeam::~MpiTeam() {
  const std::lock_guard lock(calls_);
  MPI_Comm_free(&communicator_);
}

std::size_t MpiTeam::own_cores() const {
  const std::lock_guard lock(calls_);
  MPI_Comm local = MPI_COMM_NULL;
  check_mpi(MPI_Comm_split_type(communicator_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local), "asking who is here");
  int processes = 1;
  MPI_Comm_size(local, &processes);
  MPI_Comm_free(&local);
  return std::max<std::size_t>(1, std::thread::hardware_concurrency() / static_cast<std::size_t>(processes));
}

void MpiTeam::send(const Bytes& part, int to) const {
  const std::uint64_t size = part.size();
  check_mpi(MPI_Send(&size, 1, MPI_UINT64_T, to, kTag, communicator_), "sending");
  for_each_message(part, "sending", [&](const std::byte* first, int count) {
    return MPI_Send(first, count, MPI_BYTE, to, kTag, communicator_);
  });
}

Team::Bytes MpiTeam::receive(int from) const {
  std::uint64_t size = 0;
  check_mpi(MPI_Recv(&size, 1, MPI_UINT64_T, from, kTag, communicator_, MPI_STATUS_IGNORE), "receiving");
  Bytes part(size);
  for_each_message(part, "receiving", [&](std::byte* first, int count) {
    return MPI_Recv(first, count, MPI_BYTE, from, kTag, communicator_, MPI_STATUS_IGNORE);
  });
  return part;
}

void MpiTeam::broadcast(Bytes& part) const {
  std::uint64_t size = part.size();
  check_mpi(MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator_), "sending to all");
  part.resize(size);
  for_each_message(part, "sending to all",
                   [&](std::byte* first, int count) { return MPI_Bcast(first, count, MPI_BYTE, 0, communicator_); });
}

void MpiTeam::merge(Bytes& part, const Merge& both) {
  if (alone()) return;
  const std::lock_guard lock(calls_);
  try {
    merge_in_tree(part, both);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // it hit this process alone, in the middle of a call of all
    end_all(error.what());
  }
}

void MpiTeam::merge_in_tree(Bytes& part, const Merge& both) const {
  // Merges in a tree: rank 0 receives from ranks 1, 2, 4 ...; each of them has merged the ranks up to the next one.
  part.push_back(unwinding());
  for (int step = 1; step < size_; step *= 2) {
    if (rank_ % (2 * step) != 0) {
      send(part, rank_ - step);
      break;
    }
    if (rank_ + step >= size_) continue;
    Bytes higher = receive(rank_ + step);
    if (higher.back() != part.back()) end_all("it is not where the others are");
    higher.pop_back();
    part.pop_back();
    both(part, higher);
    part.push_back(unwinding());
  }
  broadcast(part);
  part.pop_back();
}

void MpiTeam::end_all(const std::string& why) const {
  std::fprintf(stderr, "weir: one of %d processes failed alone, so that none can go on: %s\n", size_, why.c_str());
  MPI_Abort(communicator_, static_cast<int>(ErrorKind::internal));
  std::abort();
}

}  // namespace weir
