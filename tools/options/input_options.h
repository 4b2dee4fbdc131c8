// The options that say what an input file does not say itself: the same ones
// for every command that reads a volume.
#pragma once

#include <string>

#include "format/base/index.h"
#include "ingest/source_registry.h"

namespace CLI {
class App;
}

namespace weir {

/// The options as given; empty: not given.
struct InputArguments {
  std::string dims;       ///< X,Y,Z voxels
  std::string type;       ///< a name of format/base/scalar_type.h
  std::string endian;     ///< little or big
  std::string offset;     ///< a size, bytes before the first value
  std::string spacing;    ///< x,y,z world units per voxel
  std::string origin;     ///< x,y,z world position of index (0, 0, 0)
  std::string dataset;    ///< path or name inside a container
  std::string index;      ///< i,j,... on the leading axes
  bool stack = false;     ///< the input is a pattern of files, one z-slab each
  std::string missing;    ///< the stored value that says "no data"
  std::string roi;        ///< x0:x1,y0:y1,z0:z1 in index space, half open
  std::string direct_io;  ///< auto, on or off
};

/// Adds --dims, --type, --endian, --offset, --dataset, --index, --stack, --spacing, --origin, --missing, --roi and
/// --direct-io, stored in `arguments`, which must live as long as the command.
void add_input_options(CLI::App& command, InputArguments& arguments);

/// The first of the options that is given, "--dims"; empty where none is.
std::string given_input_option(const InputArguments& arguments);

/// What the options mean. Throws Error(usage) naming option, text and form where one cannot be read;
/// whether the values make sense for the file is for open_source to say.
SourceOptions parse_input(const InputArguments& arguments);

/// "X,Y,Z" of whole numbers of any sign. Throws Error(usage) naming `option`.
Index3 parse_dims(const std::string& option, const std::string& text);

}  // namespace weir
