#include "bindings/python/range_reader.h"

#include <cstring>
#include <memory>
#include <string_view>

#include "bindings/python/interpreter_end.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// Returns a reference that any thread may drop, without the interpreter's lock.
std::shared_ptr<py::function> shared_function(const py::function& function) {
  return {new py::function(function), [](py::function* kept) {
            const Locked locked;
            delete kept;
          }};
}

}  // namespace

std::function<void()> python_call(const py::function& function) {
  return [kept = shared_function(function)] { call_python(*kept, py::tuple()); };
}

RangeReader python_range_reader(const py::function& fetch) {
  return
      [kept = shared_function(fetch)](std::span<const ByteRange> ranges, std::span<const std::span<std::byte>> into) {
        const Locked locked;
        py::list asked;
        for (const ByteRange& range : ranges) asked.append(py::make_tuple(range.offset, range.bytes));
        const py::list found = call_python(*kept, py::make_tuple(asked));
        if (found.size() != ranges.size()) {
          throw Error(ErrorKind::io, cat(found.size(), " answers to ", ranges.size(), " requests for bytes"));
        }
        for (std::size_t i = 0; i < ranges.size(); ++i) {
          const auto bytes = py::cast<std::string_view>(found[i]);
          if (bytes.size() != ranges[i].bytes) {
            throw Error(ErrorKind::io,
                        cat(bytes.size(), " bytes instead of ", ranges[i].bytes, " at byte ", ranges[i].offset));
          }
          std::memcpy(into[i].data(), bytes.data(), bytes.size());
        }
      };
}

}  // namespace weir::python
