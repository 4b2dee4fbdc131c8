// Tests the parsers of the text headers of plotfiles: what they read, and their message for each kind of damage.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "ingest/amrex/amrex_header.h"
#include "ingest/amrex/cell_header.h"
#include "ingest/amrex/fab_header.h"
#include "tests/support/message_of_error.h"

namespace weir::plotfile_headers_test {
namespace {

constexpr std::string_view kHeader =
    "NavierStokes-V1.1\n2\ndensity\nx velocity\n3\n0.125\n1\n-1 0 0\n1 2 4\n2 \n((-4,0,0) (3,7,15) (0,0,0)) "
    "((-8,0,0) (7,15,15) (0,0,0)) \n7 14 \n0.25 0.25 0.25 \n0.125 0.125 0.25 \n0\n0\n0 1 0.125\n7\n-1 1\n0 2\n0 "
    "4\nLevel_0/Cell\n1 1 0.125\n14\n-1 1\n0 2\n0 4\nLevel_1/Cell\n1.0e-6\n";

/// Returns what `parse` reads from `content`, which arrives in pieces of `piece` bytes.
template <typename Parse>
auto parsed(std::string_view content, const Parse& parse, std::size_t piece = 7) {
  PlotfileText text("H", [&] {
    const std::string_view next = content.substr(0, piece);
    content.remove_prefix(next.size());
    return next;
  });
  return parse(text);
}

AmrexHeader header_of(std::string_view content) { return parsed(content, parse_amrex_header); }
CellHeader cells_of(std::string_view content) {
  return parsed(content, [&](PlotfileText& text) {
    return parse_cell_header(text, content.size(), 1U << 30U, {true, 1});
  });
}

std::string with(std::string_view content, const std::string& what, const std::string& by) {
  std::string text(content);
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(AmrexHeader, HasComponentsLevelsAndTime) {
  const AmrexHeader header = header_of(kHeader);
  EXPECT_EQ(header.components, (std::vector<std::string>{"density", "x velocity"}));
  EXPECT_EQ(header.time, 0.125);
  EXPECT_EQ(header.corner, (std::array<double, 3>{-1, 0, 0}));
  ASSERT_EQ(header.levels.size(), 2U);
  EXPECT_EQ(header.levels[0].domain, (Box{{-4, 0, 0}, {4, 8, 16}}));
  EXPECT_EQ(header.levels[1].domain, (Box{{-8, 0, 0}, {8, 16, 16}}));
  EXPECT_EQ(header.levels[1].ratio, (Index3{2, 2, 1}));
  EXPECT_EQ(header.levels[1].spacing, (std::array<double, 3>{0.125, 0.125, 0.25}));
  EXPECT_EQ(header.levels[1].cells, "Level_1/Cell");
  EXPECT_EQ(header_of(with(kHeader, "\n2 \n((", "\n(2,2,1) \n((")).levels[1].ratio, (Index3{2, 2, 1}));
}

TEST(AmrexHeader, WhatIsSaidOfLevelsThatAreNotThere_IsPassedOver) {
  std::string text = with(kHeader, "\n2 \n((", "\n2 2 4 \n((");
  text = with(text, "(7,15,15) (0,0,0)) \n7 14 \n", "(7,15,15) (0,0,0)) ((-16,0,0) (15,31,31) (0,0,0))\n7 14 28 56\n");
  const AmrexHeader header = header_of(text);
  ASSERT_EQ(header.levels.size(), 2U);
  EXPECT_EQ(header.levels[1].domain, (Box{{-8, 0, 0}, {8, 16, 16}}));
  EXPECT_EQ(header.levels[1].spacing, (std::array<double, 3>{0.125, 0.125, 0.25}));
}

TEST(AmrexHeader, NumbersOfSixDigits_FitEachOther) {
  std::string text = with(kHeader, "-1 0 0\n1 2 4\n", "100000 0.333333 0\n100008 3.0 4\n");
  text = with(text, "0.25 0.25 0.25 \n0.125 0.125 0.25 \n", "1 0.333333 0.25 \n0.5 0.166667 0.25 \n");
  EXPECT_EQ(header_of(text).levels[1].spacing, (std::array<double, 3>{0.5, 0.166667, 0.25}));
}

TEST(AmrexHeader, LargeCorners_SayLittleOfTheSizeOfCells) {
  // As float32, numbers as large as these corners are multiples of 64.
  std::string text = with(kHeader, "-1 0 0\n1 2 4\n", "1000000000 0 0\n1000000064 2 4\n");
  text = with(text, "0.25 0.25 0.25 \n0.125 0.125 0.25 \n", "5 0.25 0.25 \n2.5 0.125 0.25 \n");
  EXPECT_EQ(header_of(text).levels[0].spacing[0], 5);
}

TEST(AmrexHeader, CornersAndSizesOfCellsThatDoNotFit_AreTold) {
  const auto message = [](const std::string& what, const std::string& by) {
    return message_of_error(ErrorKind::input, [&] { header_of(with(kHeader, what, by)); });
  };
  EXPECT_EQ(message("\n1 2 4\n", "\n1 -2 4\n"),
            "H: line 9: the domain's upper corner has -2 along y, and must be above that of its lower corner, 0; the "
            "header is damaged");
  EXPECT_EQ(message("\n1 2 4\n", "\n-1 2 4\n"),
            "H: line 9: the domain's upper corner has -1 along x, and must be above that of its lower corner, -1; the "
            "header is damaged");
  EXPECT_EQ(message("0.25 0.25 0.25 \n0", "0.35 0.25 0.25 \n0"),
            "H: line 13: the size of level 0's cells along x is 0.35, and must be 0.25, as the domain reaches from -1 "
            "to 1 and has 8 cells there; the header is damaged");
  EXPECT_EQ(message("\n1 2 4\n", "\n1 2 4.001\n"),
            "H: line 13: the size of level 0's cells along z is 0.25, and must be 0.2500625, as the domain reaches "
            "from 0 to 4.001 and has 16 cells there; the header is damaged");
  EXPECT_EQ(message("0.125 0.125 0.25 ", "0.125 0.125 0.125 "),
            "H: line 14: the size of level 1's cells along z is 0.125, and must be 0.25, that of level 0, 0.25, by the "
            "ratio 1; the header is damaged");
}

TEST(AmrexHeader, BeginsWithANameAndAVersion) {
  for (const char* text : {"HyperCLaw-V1.1\n2\n", "NavierStokes-V1.", "CartGrid-V2.0"}) {
    EXPECT_TRUE(begins_as_amrex_header(text)) << text;
  }
  for (const char* text : {"", "-V1.1", "CheckPointVersion", "a b-V1.1", "HyperCLaw-V", "HyperCLaw\n-V1"}) {
    EXPECT_FALSE(begins_as_amrex_header(text)) << text;
  }
}

TEST(AmrexHeader, DamageIsToldWithItsLine) {
  struct Case {
    std::string what;
    std::string by;
    std::string message;
  };
  const std::string ratio =
      "H: line 11: the domain of level 1, -8:9,0:16,0:16, does not refine that of level 0, -4:4,0:8,0:16, by whole "
      "numbers; the header is damaged";
  for (const Case& c : std::vector<Case>{
           {"NavierStokes-V1.1", "VTK",
            "H: line 2: 'VTK' should be the name and version of a plotfile, HyperCLaw-V1.1"},
           {"1\n2\nd", "1\n0\nd", "H: line 2: the number of components is 0, and must be from 1 to 100000"},
           {"1\n2\nd", "1\n99999999999999999999\nd",
            "H: line 2: '99999999999999999999' should be the number of components"},
           {"0.125\n1\n", "0.125\n99\n", "H: line 7: the finest level is 99, and must be from 0 to 31"},
           {"-1 0 0", "-1 nan 0", "H: line 8: the domain's lower corner has nan, and must be finite"},
           {"((-4,0,0) (3,7,15)", "((-4,0,0) (-5,7,15)",
            "H: line 11: a level's domain from (-4,0,0) to (-5,7,15) has no cells; the header is damaged"},
           {"((-4,0,0)", "((-4,0)",
            "H: line 11: a level's domain has 2 axes; only plotfiles of three dimensions can be read"},
           {"((-4,0,0) (3,7,15) (0,0,0))", "((-4,0,0) (3,7,15) (1,0,0))",
            "H: line 11: a level's domain is not of cells but of faces or nodes; only cells can be read"},
           {"((-4,0,0)", "((-9999999999,0,0)",
            "H: line 11: -9999999999 in a level's domain is no 32-bit number; the header is damaged"},
           {"(7,15,15)", "(8,15,15)", ratio},
           {"0.125 0.125 0.25", "0.125 0 0.25", "H: line 14: the size of a level's cells has 0, and must be above 0"},
           {"\n0\n0\n0 1 ", "\n2\n0\n0 1 ",
            "H: line 15: the coordinates are spherical; only Cartesian ones can be read"},
           {"\n1 1 0.125", "\n2 1 0.125", "H: line 23: a level's number is 2, and must be from 1 to 1"},
           {"Level_1/Cell", "Level_0/Cell",
            "H: line 29: 'Level_0/Cell' is the path of the cells of level 1 and of level 0; the header is damaged"},
           {"Level_1/Cell", "../Cell",
            "H: line 29: '../Cell' should be the path of a level's cells, Level_0/Cell; the header is damaged"}}) {
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { header_of(with(kHeader, c.what, c.by)); }), c.message);
  }
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { header_of(kHeader.substr(0, 120)); }),
            "H: ends in line 11, where ')' of a level's domain should be; it is cut or was not written to its end");
}

constexpr std::string_view kCells =
    "1\n1\n2\n0\n(2 0\n((0,0,0) (7,7,7) (0,0,0))\n((8,0,0) (15,7,7) (0,0,0))\n)\n2\nFabOnDisk: Cell_D_00000 "
    "0\nFabOnDisk: Cell_D_00001 96\n\n2,2\n1.0e+00,nan,\n-2.5e+00,4.0e+00,\n\n2,2\n3,nan,\n2,8,\n\n";

TEST(CellHeader, HasBoxesPlacesAndRanges) {
  const CellHeader header = cells_of(kCells);
  EXPECT_EQ(header.components, 2);
  ASSERT_EQ(header.boxes.size(), 2U);
  EXPECT_EQ(header.boxes[1].box(), (Box{{8, 0, 0}, {16, 8, 8}}));
  EXPECT_EQ(header.files, (std::vector<std::string>{"Cell_D_00000", "Cell_D_00001"}));
  EXPECT_EQ(header.places[1].offset, 96U);
  EXPECT_EQ(header.places[1].file, 1U);
  EXPECT_EQ(header.ranges[0].min, -2.5);
  EXPECT_EQ(header.ranges[0].max, 3);
  EXPECT_EQ(header.ranges[1].min, 4);
  EXPECT_EQ(header.ranges[1].max, 8);
  ASSERT_EQ(header.box_ranges.size(), 2U);
  EXPECT_TRUE(std::isnan(header.box_ranges[0].min));
  EXPECT_EQ(header.box_ranges[1].min, 4);
  EXPECT_EQ(header.box_ranges[1].max, 8);
  EXPECT_FALSE(header.layout);
}

TEST(CellHeader, DamageIsToldWithItsLine) {
  struct Case {
    std::string what;
    std::string by;
    std::string message;
  };
  for (const Case& c : std::vector<Case>{
           {"1\n1\n2\n0\n", "5\n1\n2\n0\n", "H: line 1: the version is 5, and must be from 1 to 4"},
           {"1\n1\n2\n0\n", "1\n1\n2\n(1,1,0)\n",
            "H: line 4: the boxes have (1,1,0) layers of ghost cells, which cannot be read; write the plotfile without "
            "them"},
           {"(2 0", "(2000000000000 0",
            "H: line 5: 2000000000000 boxes are said to follow, and the file of 189 bytes can hold 1 to 4; it is cut "
            "or "
            "damaged"},
           {"(2 0", "(3 0", "H: line 8: ')' should be '(' of a box"},
           {")\n2\n", ")\n3\n", "H: line 9: 3 FABs for 2 boxes; the header is damaged"},
           {"FabOnDisk: Cell_D_00001", "FabOnDisk: ../x",
            "H: line 11: '../x' should be the name of a file beside Cell_H; the header is damaged"},
           {"FabOnDisk: Cell_D_00001 96", "((((((((((((", "H: line 11: '((((((((((((' should be FabOnDisk:"},
           {"2,2\n1.0", "2;2\n1.0", "H: line 13: '2;2' should be the table of the boxes' minima and maxima"}}) {
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { cells_of(with(kCells, c.what, c.by)); }), c.message);
  }
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { cells_of(kCells.substr(0, 100)); }),
            "H: line 11: 'FabO' should be FabOnDisk:");
}

TEST(FabHeader, LayoutsThatAreNotIeee_AreRefused) {
  const std::string line = "FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))((0,0,0) (3,3,3) (0,0,0)) 3\n";
  const FabHeader header = parse_fab_header(line, "D", 5);
  EXPECT_EQ(header.box, (Box{{0, 0, 0}, {4, 4, 4}}));
  EXPECT_EQ(header.components, 3);
  EXPECT_EQ(header.bytes, line.size());
  EXPECT_EQ(header.layout, (RealLayout{ScalarType::float64, false}));
  const auto message = [](const std::string& text) {
    return message_of_error(ErrorKind::input, [&] { parse_fab_header(text, "D", 5); });
  };
  EXPECT_EQ(message(with(line, "64 11", "64 15")),
            "D: offset 5: line 1: numbers of the format 64 15 52 0 1 12 0 1023 cannot be read; write the plotfile in "
            "IEEE single or double precision");
  EXPECT_EQ(message(with(line, "8 7 6 5 4 3 2 1", "2 1 4 3 6 5 8 7")),
            "D: offset 5: line 1: bytes in the order 2 1 4 3 6 5 8 7 cannot be read; write the plotfile with 8 bytes a "
            "number in rising or falling order");
  EXPECT_EQ(
      message("FAB: 8 1 i386 ((0,0,0) (3,3,3) (0,0,0)) 3\n"),
      "D: offset 5: 'FAB: 8 1 i386 ((0,0,0) (3,3,3) (0,0,0)) 3' is a FAB in the format before AMReX, which cannot "
      "be read; write it anew");
  EXPECT_EQ(message("123"),
            "D: offset 5: '123' should be the header of a FAB; Cell_H is of other files, or these are damaged");
}

}  // namespace
}  // namespace weir::plotfile_headers_test
