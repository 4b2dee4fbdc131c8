// Replaces zfp_codec.cpp and zfp_trial.cpp in a build with WEIR_ZFP=OFF.
#include "format/base/error.h"
#include "tools/sweep/zfp_codec.h"
#include "tools/sweep/zfp_trial.h"

namespace weir {
namespace {

Error no_zfp() { return {ErrorKind::usage, "this weir was built without zfp; build it with -DWEIR_ZFP=ON"}; }

}  // namespace

bool has_zfp() { return false; }

std::uint64_t zfp_stream_bytes(const Index3&, unsigned) { throw no_zfp(); }

std::optional<unsigned> zfp_block_bits(const Index3&, std::uint64_t) { throw no_zfp(); }

ZfpTrial try_zfp(VolumeSource&, const ZfpTrialOptions&, const ConversionControl&, FileSystem&) { throw no_zfp(); }

}  // namespace weir
