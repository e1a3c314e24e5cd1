// Signatures of compiled functions for inspect.signature, help() and editors.
#pragma once

#include <pybind11/pybind11.h>

namespace steplap::python {

namespace py = pybind11;

/// Adds a signature to the docstring of each function and method of the module, in the form that Python parses (`__text_signature__`).
/// Precondition: pybind11's own signatures, which Python cannot parse, are disabled.
void sign_functions(const py::module_& module);

} // namespace steplap::python
