// The processes of an MPI communicator as a team.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <mutex>
#include <string>

#include "compressor/team/team.h"

namespace weir {

/// The team of all processes of `communicator`; each of them makes one. MPI must be initialised with
/// MPI_THREAD_SERIALIZED or more. If a process unwinds from a failure while others wait for it, it ends them all
/// (MPI_Abort), because none of them could go on.
class MpiTeam final : public Team {
 public:
  explicit MpiTeam(MPI_Comm communicator);
  ~MpiTeam() override;
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void merge(Bytes& part, const Merge& both) override;

  /// Returns this process's share of its machine's cores, which the team's processes there divide; at least 1. All
  /// ranks call it.
  std::size_t own_cores() const;

  /// Hold this lock around every MPI call.
  std::mutex& calls() const { return calls_; }

 private:
  // All ranks call these functions, and hold calls_.
  void merge_in_tree(Bytes& part, const Merge& both) const;
  [[noreturn]] void end_all(const std::string& why) const;
  void send(const Bytes& part, int to) const;
  Bytes receive(int from) const;
  void broadcast(Bytes& part) const;

  MPI_Comm communicator_ = MPI_COMM_NULL;  // a copy, so that no other code's messages mix with the team's
  int rank_ = 0;
  int size_ = 1;
  mutable std::mutex calls_;
};

/// Throws Error(io) with MPI's message if `code` is not MPI_SUCCESS.
void check_mpi(int code, const std::string& action);

}  // namespace weir
