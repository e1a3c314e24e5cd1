// Signatures of compiled functions for inspect.signature, help() and editors.
#pragma once

#include <pybind11/pybind11.h>

namespace steplap::python {

namespace py = pybind11;

/// Puts a signature in front of the docstring of each function of the module and of its classes, in the form that Python reads
/// (`__text_signature__`). The functions must have been defined without pybind11's own signatures, which Python cannot read.
void sign_functions(const py::module_& module);

} // namespace steplap::python
