// weir._core: the compiled functions that the Python files of bindings/python/weir use. The Python files have the
// documentation and the keywords; the functions here take bytes for paths and texts for options.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/python/convert.h"
#include "bindings/python/errors.h"
#include "bindings/python/grid.h"
#include "bindings/python/interpreter_end.h"

namespace py = pybind11;

// pybind11's own entry gets another name, because in a subinterpreter it waits for itself. (From Python 3.13 on it is
// called in the main interpreter first.)
#define PyInit__core init_in_main_interpreter

PYBIND11_MODULE(_core, m) {
  using weir::python::Grid;
  m.doc() = "The compiled part of weir; use the package weir.";
  m.attr("__version__") = WEIR_VERSION;
  weir::python::translate_errors();
  weir::python::stop_calls_at_exit();
  m.def("convert_files", &weir::python::convert_files, py::arg("source"), py::arg("output"), py::arg("options"),
        py::arg("several"), py::arg("progress"));
  m.def("convert_array", &weir::python::convert_array, py::arg("source").noconvert(), py::arg("type"),
        py::arg("output"), py::arg("options"), py::arg("meaning"), py::arg("progress"));
  m.def("convert_device_array", &weir::python::convert_device_array, py::arg("address"), py::arg("shape"),
        py::arg("strides"), py::arg("type"), py::arg("stream"), py::arg("output"), py::arg("options"),
        py::arg("meaning"), py::arg("progress"));
  py::class_<Grid>(m, "Grid")
      .def(py::init<const std::string&>(), py::arg("path"))
      .def("close", &Grid::close)
      .def_property_readonly("closed", &Grid::closed)
      .def_property_readonly("type", &Grid::type)
      .def_property_readonly("packed", &Grid::packed)
      .def_property_readonly("name", &Grid::name)
      .def_property_readonly("background", &Grid::background)
      .def_property_readonly("range", &Grid::range)
      .def_property_readonly("extent", &Grid::extent)
      .def_property_readonly("index_origin", &Grid::index_origin)
      .def_property_readonly("spacing", &Grid::spacing)
      .def_property_readonly("origin", &Grid::origin)
      .def_property_readonly("bytes", &Grid::bytes)
      .def_property_readonly("levels", &Grid::levels)
      .def("sidecar", &Grid::sidecar)
      .def("checked_sidecar", &Grid::checked_sidecar, py::arg("text"), py::arg("path"))
      .def("read", &Grid::read, py::arg("lo"), py::arg("hi"), py::arg("level"))
      .def("read_strided", &Grid::read_strided, py::arg("first"), py::arg("step"), py::arg("count"))
      .def("sample", &Grid::sample, py::arg("points").noconvert(), py::arg("trilinear"))
      .def("macrocells", &Grid::macrocells)
      .def("render", &Grid::render, py::arg("options"), py::arg("linear"), py::arg("progress"))
      .def("verify", &Grid::verify, py::arg("progress"));
  m.def(
      "open_remote",
      [](const std::string& url, const py::function& fetch, const py::function& interrupt, const std::string& cache) {
        return std::make_unique<Grid>(url, fetch, interrupt, cache);
      },
      py::arg("url"), py::arg("fetch"), py::arg("interrupt"), py::arg("cache"));
}

#undef PyInit__core

extern "C" PYBIND11_EXPORT PyObject* PyInit__core();
extern "C" PYBIND11_EXPORT PyObject* PyInit__core() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return init_in_main_interpreter();
  PyErr_SetString(PyExc_ImportError,
                  "weir cannot be imported in a subinterpreter; use the main interpreter, or another process");
  return nullptr;
}
