// SPDX-License-Identifier: BSL-1.0
// quadrant._core: what the package `quadrant` calls. Text and arrays in, text and arrays out.
#include "parts.hpp"

#include <quadrant/base/error.hpp>
#include <quadrant/diagnosis/text/bad_input.hpp>

PYBIND11_MODULE(_core, m) {
    m.doc() = "The compiled part of the package quadrant.";
    m.attr("version") = QUADRANT_VERSION;
    pybind11::register_exception<quadrant::diagnosis::bad_input>(m, "BadInput", PyExc_ValueError);
    pybind11::register_exception<quadrant::invalid_parameter>(m, "InvalidParameter", PyExc_ValueError);
    quadrant_python::add_diagnosis(m);
    quadrant_python::add_blocks(m);
}
