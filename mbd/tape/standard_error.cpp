// Debian's asmjit is a static library built for programs. A shared library can contain it except for its reference to the address of
// `stderr` in another library. With --wrap=stderr that reference is to this variable of the module.
#include <cstdio>

extern "C" {
extern std::FILE* __real_stderr;                                          // name defined by the linker
__attribute__((visibility("hidden"))) std::FILE* __wrap_stderr = nullptr; // name defined by the linker
}

namespace {

const bool k_is_set = (__wrap_stderr = __real_stderr) != nullptr; // when the module is loaded

} // namespace
