// Debian's asmjit is a static library made for programs. It refers to the address of `stderr` in the C library, which a shared library must
// not contain. With the linker option --wrap=stderr it refers to the variable below instead.
#include <cstdio>

extern "C" {
extern std::FILE* __real_stderr;                                          // name defined by the linker
__attribute__((visibility("hidden"))) std::FILE* __wrap_stderr = nullptr; // name defined by the linker
}

namespace {

const bool k_is_set = (__wrap_stderr = __real_stderr) != nullptr; // when the module is loaded

} // namespace
