#include "tools/python/signatures.h"

#include <cstring>
#include <string>

namespace steplap::python {

namespace {

// Returns a signature such as "($self, end=None)". Python omits "$self" for bound methods.
std::string signature_of(const py::detail::function_record& function) {
  std::string text;
  if (function.is_method && function.args.empty()) text = "self";
  for (const py::detail::argument_record& argument : function.args) {
    if (!text.empty()) text += ", ";
    text += argument.name;
    if (argument.value) text += std::string("=") + argument.descr;
  }
  return "(" + text + ")";
}

void sign(const py::handle& object) {
  const py::handle function = py::detail::get_function(object);
  if (!PyCFunction_Check(function.ptr())) return;
  const auto capsule = py::reinterpret_borrow<py::capsule>(PyCFunction_GET_SELF(function.ptr()));
  if (!py::detail::is_function_record_capsule(capsule)) return;
  auto* const record = capsule.get_pointer<py::detail::function_record>();
  const std::string text = record->name + signature_of(*record) + "\n--\n\n" + (record->doc ? record->doc : "");
  record->def->ml_doc = ::strdup(text.c_str()); // never freed, because the function exists as long as the module
}

} // namespace

void sign_functions(const py::module_& module) {
  for (const auto& [name, member] : module.attr("__dict__").cast<py::dict>()) {
    if (!py::isinstance<py::type>(member)) sign(member);
    else
      for (const auto& [own, part] : py::dict(member.attr("__dict__"))) sign(part);
  }
}

} // namespace steplap::python
