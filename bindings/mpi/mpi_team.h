// The processes of an MPI communicator as a team.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <mutex>
#include <string>

#include "compressor/team/team.h"

namespace weir {

/// Of all processes of `communicator`, which each make one. MPI must have been initialised with MPI_THREAD_SERIALIZED
/// or more. A process that unwinds from a failure while others wait for it ends them all (MPI_Abort), since none of
/// them could go on.
class MpiTeam final : public Team {
 public:
  explicit MpiTeam(MPI_Comm communicator);
  ~MpiTeam() override;
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void merge(Bytes& part, const Merge& both) override;

  /// This process's part of its machine's cores, which the team's processes on it divide; at least 1. All ranks ask.
  std::size_t own_cores() const;

  /// Held around every call of MPI.
  std::mutex& calls() const { return calls_; }

 private:
  // All ranks call them, and hold calls_.
  void merge_in_tree(Bytes& part, const Merge& both) const;
  [[noreturn]] void end_all(const std::string& why) const;
  void send(const Bytes& part, int to) const;
  Bytes receive(int from) const;
  void broadcast(Bytes& part) const;

  MPI_Comm communicator_ = MPI_COMM_NULL;  // a copy of its own: no message of anyone else's comes in between
  int rank_ = 0;
  int size_ = 1;
  mutable std::mutex calls_;
};

/// Throws Error(io) with MPI's words where `code` is not MPI_SUCCESS.
void check_mpi(int code, const std::string& action);

}  // namespace weir
