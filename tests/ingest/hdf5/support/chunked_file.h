// Writes a chunked dataset in an HDF5 file of its own with libhdf5. Tests of the chunk reader can set the stored bytes
// of each chunk.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace weir {

/// How the dataset is created. Axes are in the file's order, slowest first.
struct ChunkedShape {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;
  std::vector<H5Z_filter_t> filters;     ///< any of deflate, shuffle and fletcher32, in the order of use
  bool partial_unfiltered = false;       ///< H5D_CHUNK_DONT_FILTER_PARTIAL_CHUNKS
  hid_t type = H5T_NATIVE_FLOAT;         ///< type in the file
  H5F_libver_t oldest = H5F_LIBVER_V18;  ///< H5F_LIBVER_V110 gives chunk indices of HDF5 1.10
};

/// Creates a file with the dataset "d", which stays open for reading and writing until close() or the destructor.
class ChunkedFile {
 public:
  ChunkedFile(const std::string& path, const ChunkedShape& shape) : path_(path), shape_(shape) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, shape.oldest, H5F_LIBVER_LATEST);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    const auto rank = static_cast<int>(shape.extent.size());
    const hid_t space = H5Screate_simple(rank, shape.extent.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, rank, shape.chunk.data());
    if (shape.partial_unfiltered) H5Pset_chunk_opts(creation, H5D_CHUNK_DONT_FILTER_PARTIAL_CHUNKS);
    for (const H5Z_filter_t filter : shape.filters) {
      if (filter == H5Z_FILTER_DEFLATE) H5Pset_deflate(creation, 1);
      if (filter == H5Z_FILTER_SHUFFLE) H5Pset_shuffle(creation);
      if (filter == H5Z_FILTER_FLETCHER32) H5Pset_fletcher32(creation);
    }
    dataset_ = H5Dcreate2(file_, "d", shape.type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    EXPECT_GE(dataset_, 0) << path;
    H5Pclose(creation);
    H5Sclose(space);
  }
  ~ChunkedFile() { close(); }
  ChunkedFile(const ChunkedFile&) = delete;
  ChunkedFile& operator=(const ChunkedFile&) = delete;

  hid_t dataset() const { return dataset_; }
  hsize_t elements() const {
    return std::accumulate(shape_.extent.begin(), shape_.extent.end(), hsize_t{1}, std::multiplies<>());
  }

  /// Writes all values, which are in the file's order.
  template <typename T>
  void write(hid_t memory_type, const std::vector<T>& values) const {
    ASSERT_EQ(values.size(), elements());
    ASSERT_GE(H5Dwrite(dataset_, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  }
  /// Writes the stored bytes of one chunk as they are. Bit i of `left_out` says that filter i was not applied.
  void write_chunk(const std::vector<hsize_t>& corner, std::span<const std::byte> bytes, std::uint32_t left_out = 0) {
    ASSERT_GE(H5Dwrite_chunk(dataset_, H5P_DEFAULT, left_out, corner.data(), bytes.size(), bytes.data()), 0);
  }
  /// Returns all values as libhdf5 itself reads them, as float32.
  std::vector<float> read() const {
    std::vector<float> values(elements());
    EXPECT_GE(H5Dread(dataset_, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    return values;
  }
  /// Writes everything to the file and opens it again, so that nothing of the file is cached.
  void reopen() {
    close();
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    dataset_ = H5Dopen2(file_, "d", H5P_DEFAULT);
    EXPECT_GE(dataset_, 0) << path_;
  }
  void close() {
    if (dataset_ >= 0) H5Dclose(dataset_);
    if (file_ >= 0) H5Fclose(file_);
    dataset_ = file_ = H5I_INVALID_HID;
  }

 private:
  std::string path_;
  ChunkedShape shape_;
  hid_t file_ = H5I_INVALID_HID;
  hid_t dataset_ = H5I_INVALID_HID;
};

}  // namespace weir
