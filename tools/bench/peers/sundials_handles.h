#pragma once

// Classes that own SUNDIALS objects and free them.

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>

namespace steplap::peers {

struct SundialsContext {
  SundialsContext() {
    if (SUNContext_Create(nullptr, &context) != 0) std::abort();
  }
  ~SundialsContext() { SUNContext_Free(&context); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
  SUNContext context = nullptr;
};

// A SUNDIALS vector that uses memory of the caller.
class VectorView {
public:
  VectorView(int size, double* data, SUNContext context) : vector_(N_VMake_Serial(size, data, context)) {}
  ~VectorView() { N_VDestroy(vector_); }
  VectorView(const VectorView&) = delete;
  VectorView& operator=(const VectorView&) = delete;
  [[nodiscard]] N_Vector get() const { return vector_; }

private:
  N_Vector vector_;
};

[[nodiscard]] inline double* data_of(N_Vector v) { return N_VGetArrayPointer(v); }

// Stops the program with a message, because a failure here is an error in the peer program.
inline void require(int flag, const char* what) {
  if (flag >= 0) return;
  std::fprintf(stderr, "SUNDIALS: %s returned %d\n", what, flag);
  std::exit(4);
}

} // namespace steplap::peers
