// Tests the spacing, origin and note that the coordinates of an axis give.
#include "ingest/axes/coordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace weir::coordinates_test {
namespace {

constexpr double kDouble = std::numeric_limits<double>::epsilon();
constexpr double kFloat = 1.1920929e-7;

AxisPlace placed(const std::vector<double>& coordinates, double precision = kDouble) {
  AxisPlace axis;
  place_by_coordinates(coordinates, precision, axis);
  return axis;
}

TEST(Coordinates, RegularCoordinatesGiveSpacingAndOrigin) {
  const AxisPlace axis = placed({-1, -0.5, 0, 0.5});
  EXPECT_EQ(axis.spacing, 0.5);
  EXPECT_EQ(axis.origin, -1);
  EXPECT_EQ(axis.note, "");
}

TEST(Coordinates, RoundedCoordinatesAreRegular) {
  EXPECT_EQ(placed({0, 0.3333, 0.6667, 1}).note, "");
  std::vector<double> far;  // seconds since an epoch; as float32, neighbouring numbers are 64 apart
  for (int i = 0; i < 10; ++i) far.push_back(static_cast<double>(static_cast<float>(1.0e9 + i * 3600.0)));
  EXPECT_EQ(placed(far, kFloat).note, "");
  EXPECT_NE(placed(far).note, "");
}

TEST(Coordinates, IrregularOnesAreTakenAsIndices) {
  for (const std::vector<double>& coordinates :
       {std::vector<double>{0, 1, 3}, {0, 1, 0}, {5, 5, 5}, {0, 1.002, 2}, {-1.5e308, 0, 1.5e308}}) {
    const AxisPlace axis = placed(coordinates);
    EXPECT_EQ(axis.spacing, std::nullopt);
    EXPECT_EQ(axis.origin, std::nullopt);
    EXPECT_TRUE(axis.note.starts_with("irregular coordinates from ")) << axis.note;
  }
}

TEST(Coordinates, FallingOnesGiveThePlacesOfElementsInReverseOrder) {
  const AxisPlace axis = placed({1000, 750, 500});
  EXPECT_EQ(axis.spacing, 250);
  EXPECT_EQ(axis.origin, 500);
  EXPECT_TRUE(axis.falls);
  EXPECT_EQ(axis.note, "falls from 1000 to 500");
  EXPECT_FALSE(placed({500, 750, 1000}).falls);
  EXPECT_FALSE(placed({1000, 750, 600}).falls) << "irregular: indices are the places";
}

TEST(Coordinates, SingleCoordinateGivesAnOriginOnly) {
  const AxisPlace axis = placed({7});
  EXPECT_EQ(axis.spacing, std::nullopt);
  EXPECT_EQ(axis.origin, 7);
}

TEST(Coordinates, NonFiniteCoordinatesAreSaid) {
  for (const std::vector<double>& coordinates :
       {std::vector<double>{}, {std::nan("")}, {0, std::numeric_limits<double>::infinity()}}) {
    const AxisPlace axis = placed(coordinates);
    EXPECT_EQ(axis.spacing, std::nullopt);
    EXPECT_EQ(axis.origin, std::nullopt);
    EXPECT_EQ(axis.note, coordinates.empty() ? "" : "coordinates that are missing or not finite, taken as indices");
    EXPECT_TRUE(axis.coordinates.empty());
  }
}

}  // namespace
}  // namespace weir::coordinates_test
