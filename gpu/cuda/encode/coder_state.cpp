#include "gpu/cuda/encode/coder_state.h"

#include <vector>

#include "format/packed/block_encode.h"

namespace weir {
namespace {

struct EncoderTables {
  CostTables costs;
  CodeTables codes;
};

// The tables are made once, because saving one step of a simulation takes only about ten times as long as making
// them.
const EncoderTables& built_in_encoder_tables() {
  static const auto* const tables = [] {
    auto* const made = new EncoderTables;
    make_encoder_tables(built_in_tables(), made->costs, made->codes);
    return made;
  }();
  return *tables;
}

}  // namespace

CoderState::CoderState(int device, std::size_t most_boxes, std::function<void(const Error&)> say)
    : context(device), failed(std::move(say)), costs(1), codes(1), digests(1), boxes(most_boxes) {
  const EncoderTables& tables = built_in_encoder_tables();
  costs.upload({&tables.costs, 1});
  codes.upload({&tables.codes, 1});
  digests.upload(std::vector<DigestTables>(1));
}

}  // namespace weir
