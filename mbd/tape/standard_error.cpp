// Debian's asmjit is an archive of code for programs. A shared object can hold it but for one thing, the address of `stderr`, which is another
// library's. With --wrap=stderr all that is linked in finds this one, which is the module's own.
#include <cstdio>

extern "C" {
extern std::FILE* __real_stderr;                                          // NOLINT: the linker's name for the library's
__attribute__((visibility("hidden"))) std::FILE* __wrap_stderr = nullptr; // NOLINT: the linker's name
}

namespace {

const bool k_is_set = (__wrap_stderr = __real_stderr) != nullptr; // when the module is loaded

} // namespace
