// Helpers for tests that read files of h5py and netCDF4 and compare the values with what these libraries read.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/python.h"

namespace weir {

/// The beginning of every script. Changes to the directory sys.argv[1]. Defines values(), which makes random values of
/// any type, and expect(name, values), which writes the values for expected(name): float32, x fastest.
inline constexpr const char* kPrelude = R"(
import sys, os, numpy as np, h5py
os.chdir(sys.argv[1])
rng = np.random.default_rng(7)
SHAPE = (5, 7, 9)
def values(dtype, shape=SHAPE):
    dtype = np.dtype(dtype)
    if dtype.kind == "f": return rng.normal(size=shape).astype(dtype)
    info = np.iinfo(dtype)
    v = rng.integers(info.min, info.max, shape, dtype.newbyteorder("="), endpoint=True).astype(dtype)
    v.flat[0], v.flat[-1] = info.min, info.max
    return v
def expect(name, values):
    np.asarray(values).astype("<f4").tofile(name + ".expected")
)";

/// Runs kPrelude and then `script` in the directory of `scratch`.
inline void write_by_h5py(const Scratch& scratch, const std::string& script) {
  ASSERT_TRUE(run_python(kPrelude + script, scratch.path("")));
}

inline std::vector<float> expected(const Scratch& scratch, const std::string& name) {
  const std::string path = scratch.path(name + ".expected");
  EXPECT_TRUE(std::filesystem::exists(path)) << path;
  std::vector<float> values(std::filesystem::file_size(path) / sizeof(float));
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  return values;
}

inline SourceOptions dataset_options(const std::string& dataset, std::vector<std::int64_t> index = {}) {
  SourceOptions options;
  options.dataset = dataset;
  options.index = std::move(index);
  return options;
}

inline std::vector<float> all_values(VolumeSource& source) {
  std::vector<float> values(static_cast<std::size_t>(source.info().domain().voxels()));
  source.read(source.info().domain(), values);
  return values;
}

/// Returns whether the values are equal bit for bit. A NaN equals a NaN of the same bits.
inline bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Checks that the dataset that `options` names has the values that the script gave to expect(name, ...). Reads it
/// whole and in boxes that lie across its chunks.
inline void expect_reads(const Scratch& scratch, const std::string& file, const SourceOptions& options,
                         const std::string& name) {
  SCOPED_TRACE(file + ": " + options.dataset);
  const auto source = open_source(scratch.path(file), options);
  const std::vector<float> whole = expected(scratch, name);
  ASSERT_EQ(whole.size(), static_cast<std::size_t>(source->info().domain().voxels()));
  EXPECT_TRUE(same_bits(all_values(*source), whole));
  const Index3 e = source->info().extent;
  for (const Box& box :
       {Box{{1, 1, 1}, {e.x - 1, e.y - 2, e.z}}, Box{{0, 2, 0}, {e.x, e.y, 2}}, Box{{e.x - 1, e.y - 1, e.z - 1}, e}}) {
    std::vector<float> part(static_cast<std::size_t>(box.voxels()));
    source->read(box, part);
    std::vector<float> same;
    for (std::int64_t i = 0; i < box.voxels(); ++i) {
      same.push_back(whole[static_cast<std::size_t>(linear_index(box.lo + index_at(i, box.extent()), e))]);
    }
    EXPECT_TRUE(same_bits(part, same));
  }
}

}  // namespace weir
