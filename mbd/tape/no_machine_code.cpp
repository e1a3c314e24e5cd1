// Replaces machine_code.cpp if the program is built without machine code.
#include "mbd/tape/machine_code.h"

#include "mbd/base/portable_math.h"
#include "mbd/tape/sine_lanes.h"

namespace steplap {

bool MachineCode::is_available() { return false; }
InstructionSet MachineCode::best_instructions() { return InstructionSet::sse2; }

void sin_cos_of_block(const double* x, double* sines, double* cosines) {
  for (int l = 0; l < 8; ++l) {
    const portable::SinCos of = portable::sin_cos(x[l]);
    sines[l] = of.sin;
    cosines[l] = of.cos;
  }
}

MachineCode::MachineCode(const Tape&, InstructionSet) {}
MachineCode::MachineCode(MachineCode&&) noexcept {}
MachineCode& MachineCode::operator=(MachineCode&&) noexcept { return *this; }
MachineCode::~MachineCode() = default;

} // namespace steplap
