// A team with threads of this process as its ranks.
#pragma once

#include <barrier>
#include <functional>
#include <thread>
#include <vector>

#include "compressor/team/team.h"

namespace weir {

class ThreadTeam {
 public:
  explicit ThreadTeam(int size) : parts_(static_cast<std::size_t>(size)), arrived_(size) {}

  /// Calls `work` on one thread for each rank.
  void run(const std::function<void(Team&)>& work) {
    std::vector<std::thread> threads;
    for (int rank = 0; rank < static_cast<int>(parts_.size()); ++rank) {
      threads.emplace_back([this, rank, &work] {
        Rank team(*this, rank);
        work(team);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }

 private:
  class Rank final : public Team {
   public:
    Rank(ThreadTeam& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.parts_.size()); }
    void merge(Bytes& part, const Merge& both) override {
      all_.parts_[static_cast<std::size_t>(rank_)] = part;
      all_.arrived_.arrive_and_wait();
      Bytes sum = all_.parts_.front();
      for (std::size_t i = 1; i < all_.parts_.size(); ++i) both(sum, all_.parts_[i]);
      all_.arrived_.arrive_and_wait();
      part = sum;
    }

   private:
    ThreadTeam& all_;
    int rank_;
  };

  std::vector<Team::Bytes> parts_;
  std::barrier<> arrived_;
};

}  // namespace weir
