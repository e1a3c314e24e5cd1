#include "tools/python/bindings.h"
#include "tools/python/signatures.h"

#include "mbd/run/version.h"

PYBIND11_MODULE(_steplap, module) {
  using namespace steplap::python;
  py::options options;
  options.disable_function_signatures(); // sign_functions() adds signatures that Python can parse
  module.doc() = "Planar multibody dynamics with exact friction: models, runs, verdicts.";
  module.attr("__version__") = steplap::k_version;
  add_computation(module);
  add_errors(module);
  add_model(module);
  add_analysis(module);
  add_run(module);
  add_samples(module);
  sign_functions(module);
}
