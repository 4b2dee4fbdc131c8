#include "ingest/raw/foreign_format.h"

#include <fstream>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir::foreign_format_test {
namespace {

std::string behind(std::size_t offset, const std::string& magic) { return std::string(offset, '\0') + magic; }

class ForeignFormat : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) {
    const std::string path = scratch_.path(name);
    std::ofstream(path, std::ios::binary) << bytes + std::string(300, '\0');
    return path;
  }
  /// Returns the error message of opening `path`, without the path.
  std::string refusal(const std::string& path, ErrorKind kind = ErrorKind::input) {
    const std::string text = message_of_error(kind, [&] { open_source(path, {}); });
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    return text.substr(std::min(text.size(), path.size() + 2));
  }

  Scratch scratch_;
};

TEST_F(ForeignFormat, FirstBytesOfAFormat_AreNamed) {
  const std::string remedy = ", which weir does not read; convert it to raw, HDF5, Zarr, NRRD or NIfTI";
  EXPECT_EQ(refusal(write("a.tif", std::string("II*\0", 4))), "is a TIFF file" + remedy);
  EXPECT_EQ(refusal(write("b.bin", std::string("MM\0*", 4))), "is a TIFF file" + remedy);
  EXPECT_EQ(refusal(write("c.tiff", std::string("II+\0", 4))), "is a BigTIFF file" + remedy);
  EXPECT_EQ(refusal(write("d.dcm", behind(128, "DICM"))), "is a DICOM file" + remedy);
  EXPECT_EQ(refusal(write("e.mrc", behind(208, "MAP "))), "is an MRC file" + remedy);
}

TEST_F(ForeignFormat, NamesOfAFormat_AreKnown) {
  EXPECT_EQ(refusal(write("a.mgz", "\x1F\x8B")),
            "is a volume of FreeSurfer, which weir does not read; convert it to NIfTI with mri_convert");
  EXPECT_EQ(refusal(write("a.PVTI", "<?xml version=\"1.0\"?>")),
            "is a parallel VTK image, which weir does not read; write it as one .vti file, or name one of its pieces");
  for (const char* const name : {"a.xdmf", "a.xmf"}) {
    EXPECT_EQ(refusal(write(name, "<?xml version=\"1.0\"?>")),
              "is an XDMF file, which weir does not read; name the HDF5 file that its arrays lie in");
  }
}

TEST_F(ForeignFormat, ImageWithAHeaderBesideIt_NamesTheHeader) {
  const std::string image = write("a.img", "");
  write("a.hdr", std::string("\0\0\1\x5C", 4));
  EXPECT_EQ(refusal(image),
            "has the values of an image whose header is " + scratch_.path("a.hdr") + "; give that instead");
  write("b.hdr", "ENVI");
  EXPECT_EQ(refusal(write("b.img", ""), ErrorKind::usage),
            "extent unknown; give --dims X,Y,Z and --type or name the file NAME_XxYxZ_TYPE.raw");
}

TEST_F(ForeignFormat, ExtentThatIsGiven_IsBelieved) {
  SourceOptions options;
  options.extent = Index3{4, 19, 4};
  options.type = ScalarType::uint8;
  EXPECT_EQ(open_source(write("a.tif", std::string("II*\0", 4)), options)->info().extent, (Index3{4, 19, 4}));
}

}  // namespace
}  // namespace weir::foreign_format_test
