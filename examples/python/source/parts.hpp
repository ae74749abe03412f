// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

/// The module in three files: exceptions and version, the diagnosis, the blocks.
namespace quadrant_python {
namespace py = pybind11;

/// One-dimensional, of doubles, without gaps; converted where it is another array.
using array = py::array_t<double, py::array::c_style | py::array::forcecast>;

void add_diagnosis(py::module_& m);
void add_blocks(py::module_& m);

/// Names and shape for messages: one dimension is asked for.
inline std::size_t rows_of(const array& x, const char* name) {
    if (x.ndim() != 1) throw py::value_error(std::string(name) + ": must have one dimension");
    return static_cast<std::size_t>(x.shape(0));
}

} // namespace quadrant_python
